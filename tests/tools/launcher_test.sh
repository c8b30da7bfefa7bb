#!/usr/bin/env bash
# launcher_test.sh SOURCE_DIR CASE: one case of the launcher tools/merlin, in a throw-away copy of it, in a folder with
# spaces, with stand-ins for whatever would install, download or build something.
set -euo pipefail
source_dir=$1 case=$2

world=$(mktemp -d "${TMPDIR:-/tmp}/merlin launcher.XXXXXX")
trap 'rm -rf "$world"' EXIT
top="$world/a clone"
mkdir -p "$top/tools/cli" "$world/bin" "$world/elsewhere"
cp -r "$source_dir/tools/merlin" "$source_dir/tools/setup" "$top/tools"
cp "$source_dir/tools/cli/help.txt" "$top/tools/cli"
cp "$source_dir/CMakePresets.json" "$top"
export PATH="$world/bin:$PATH" MERLIN_OS_RELEASE="$world/os-release"
unset MUJOCO_ROOT MERLIN_ORACLES
echo 'ID=debian' >"$MERLIN_OS_RELEASE"
cd "$world/elsewhere"

stand_in() { # name, its lines
  printf '#!/usr/bin/env bash\n%s\n' "$2" >"$world/bin/$1"
  chmod +x "$world/bin/$1"
}
fail() {
  echo "FAILED: $1"
  cat "$world/out" "$world/err" 2>/dev/null
  exit 1
}
merlin() { # expected exit code, arguments
  local expected=$1 got=0
  shift
  # A background job may have been started with Ctrl-C ignored; the launcher under test must not inherit that.
  env --default-signal=INT "$top/tools/merlin" "$@" >"$world/out" 2>"$world/err" || got=$?
  [ "$got" = "$expected" ] || fail "merlin $* gave exit code $got instead of $expected"
}
says() { grep -qF -- "$1" "$world/out" "$world/err" || fail "nothing says '$1'"; }
one_sentence() { [ "$(grep -c . "$world/err")" = "$1" ] || fail "$1 lines expected on stderr"; }
nothing_half_done() {
  [ ! -e "$top/.deps/mujoco" ] || fail "a MuJoCo folder was left"
  [ -z "$(find "$top/.deps" -name '.fetch.*' 2>/dev/null)" ] || fail "a half-written folder was left"
  [ ! -e "$top/build" ] || fail "something was built"
}
all_packages_there() { stand_in dpkg-query "for name; do case \$name in -*|*{*) ;; *) echo \"ii \$name\";; esac; done"; }
no_packages_there() { stand_in dpkg-query 'exit 1'; }
# pip as the launcher calls it, with a wheel made here in place of the published one.
pip_that_fetches() { # file
  stand_in pip "while [ \$# -gt 0 ]; do [ \"\$1\" = --dest ] && dest=\$2; shift; done; cp '$1' \"\$dest/mujoco_core-4.0.0-any.whl\""
}
make_wheel() { # file
  python3 - "$1" <<'PYTHON'
import sys, zipfile
with zipfile.ZipFile(sys.argv[1], "w") as wheel:
    for name in ["mujoco/include/mujoco/mujoco.h", "mujoco/libmujoco.so.4.0.0", "mujoco/doc/index.rst", "mujoco/other.py",
                 "mujoco_core-4.0.0.dist-info/licenses/LICENSE", "mujoco_core-4.0.0.dist-info/METADATA"]:
        wheel.writestr(name, "x")
PYTHON
}
# The copy under test expects this wheel: only the published hashes are replaced.
expect_wheel() { sed -i "s/echo [0-9a-f]\{64\}/echo $(sha256sum <"$1" | cut -d' ' -f1)/" "$top/tools/setup/mujoco.sh"; }
# A build that is done at once; its program says what it was called with and exits with 7.
builds_nothing() {
  stand_in program 'echo "program got: $*"; exit 7'
  stand_in cmake "mkdir -p build/release/tools; cp '$world/bin/program' build/release/tools/merlin; touch build/release/build.ninja"'
for a; do case $a in -DMUJOCO_ROOT*) echo "${a#-D}" ;; esac; done >build/release/CMakeCache.txt
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >>build/release/CMakeCache.txt'
  stand_in ninja 'echo "ninja: no work to do."'
}

case_HelpWorksBeforeAnySetUp() {
  no_packages_there
  merlin 0 --help && says "usage: tools/merlin"
  [ "$(wc -l <"$world/out")" -le 24 ] || fail "the help does not fit a screen"
  [ "$(wc -L <"$world/out")" -le 80 ] || fail "a line of the help is too long"
  merlin 2 && says "usage: tools/merlin"
  merlin 2 rum && says "no 'rum'" && says "did you mean 'run'?"
  merlin 2 '.*' && says "no '.*'"
  merlin 2 test nonsense && says "-R NAME"
  merlin 2 --no-twin && says "usage: tools/merlin"
  merlin 2 --no-twin rum && says "did you mean 'run'?"
  merlin 2 --no-twin test && says "builds both programs"
  nothing_half_done
}

case_OtherSystemsGetTheListOfPackages() {
  echo 'ID=fedora' >"$MERLIN_OS_RELEASE"
  merlin 3 doctor && says "libembree-dev" && says fedora
  rm "$MERLIN_OS_RELEASE"
  merlin 3 doctor && says "libembree-dev"
  nothing_half_done
}

case_MissingPackagesAreInstalledOnceSaid() {
  all_packages_there
  sed -i "s/) echo \"ii/libfmt-dev) ;; *) echo \"ii/" "$world/bin/dpkg-query"
  stand_in id 'echo 0'
  stand_in apt-get "echo \"\$*\" >>'$world/apt'"
  stand_in pip 'exit 1'
  merlin 3 doctor && says "apt-get as root" && says ": libfmt-dev"
  grep -q -- "--no-install-recommends install libfmt-dev$" "$world/apt" || fail "not exactly the missing package was installed"
  stand_in id 'echo 1000'
  stand_in sudo "echo sudo >>'$world/apt'; \"\$@\""
  merlin 3 doctor && says "through sudo"
  grep -q '^sudo$' "$world/apt" || fail "sudo was not called"
}

case_PackagesWithoutNetworkStopWithThree() {
  no_packages_there
  stand_in id 'echo 0'
  stand_in apt-get 'echo "E: Failed to fetch http://deb"; exit 100'
  merlin 3 doctor && says "set-up stopped at the system packages" && says "E: Failed to fetch"
  one_sentence 2
  nothing_half_done
}

case_MuJoCoWithoutNetworkStopsWithThree() {
  all_packages_there
  stand_in pip 'echo "no such host" >&2; exit 1'
  merlin 3 doctor && says "set-up stopped at fetching MuJoCo"
  one_sentence 2
  nothing_half_done
}

case_AWheelWithAnotherHashIsDeleted() {
  all_packages_there
  make_wheel "$world/wheel"
  pip_that_fetches "$world/wheel"
  merlin 3 doctor && says "SHA-256"
  one_sentence 2
  nothing_half_done
}

case_InterruptedUnpackingLeavesNothing() {
  all_packages_there
  make_wheel "$world/wheel"
  expect_wheel "$world/wheel"
  pip_that_fetches "$world/wheel"
  # Unpacks, and is struck by Ctrl-C as the first piece is about to move.
  stand_in mv 'kill -INT $PPID; sleep 0.2; exit 1'
  merlin 130 doctor
  nothing_half_done
}

case_MuJoCoIsUnpackedWholeAndKept() {
  all_packages_there
  builds_nothing
  make_wheel "$world/wheel"
  expect_wheel "$world/wheel"
  pip_that_fetches "$world/wheel"
  mkdir -p "$top/.deps/mujoco/stale"
  merlin 7 doctor --json && says "program got: doctor --json"
  [ "$(cd "$top/.deps/mujoco" && find . -type f | sort | tr '\n' ' ')" = \
    "./.complete ./doc/index.rst ./include/mujoco/mujoco.h ./libmujoco.so.4.0.0 ./licenses/LICENSE " ] || fail "other files were unpacked"
  stand_in pip 'exit 1'
  ln -s "$top/tools/merlin" "$world/bin/merlin-link"
  (cd / && ! "$world/bin/merlin-link" list >"$world/out" 2>"$world/err") || fail "a call through a link"
  says "program got: list"
}

case_MujocoRootIsChecked() {
  all_packages_there
  builds_nothing
  export MUJOCO_ROOT="$world/own"
  merlin 3 doctor && says "$MUJOCO_ROOT" && one_sentence 1
  nothing_half_done
  mkdir -p "$MUJOCO_ROOT/include/mujoco" && touch "$MUJOCO_ROOT/include/mujoco/mujoco.h" "$MUJOCO_ROOT/libmujoco.so.4.0.0"
  merlin 7 doctor && says "program got: doctor"
  grep -qxF "MUJOCO_ROOT:PATH=$MUJOCO_ROOT" "$top/build/release/CMakeCache.txt" || fail "CMake was not told"
}

# The build's progress on a terminal of so many columns (0: it does not tell); what stood on its lines goes to out.
on_a_terminal() { # columns, COLUMNS
  COLUMNS=$2 python3 - "$top" "$1" >"$world/out" <<'PYTHON'
import fcntl, os, pty, struct, sys, termios
top, columns = sys.argv[1], int(sys.argv[2])
child, terminal = pty.fork()
if child == 0:
    sys.stdin.readline()  # until the terminal has its size
    os.execvp("bash", ["bash", "-c", """
        set -euo pipefail
        say() { echo "merlin: $*" >&2; }
        . "$0/tools/setup/build.sh"
        printf '[1/20] Building a\\nwarning\\n[20/20] Linking b\\n' | show_progress "building release (log: build/release/build.log)"
        """, top])
fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
os.write(terminal, b"\n")
seen = b""
try:
    while part := os.read(terminal, 4096):
        seen += part
except OSError:
    pass
for line in seen.decode().replace("\n", "\r").split("\r"):
    print(line.replace("\x1b[K", ""))
PYTHON
}

case_ProgressFitsTheTerminal() {
  for size in "30 200" "0 30"; do
    # shellcheck disable=SC2086
    on_a_terminal $size
    [ "$(wc -L <"$world/out")" = 29 ] || fail "the line does not fit 30 columns"
    says "[1/20]" && says "[20/20]"
  done
  on_a_terminal 200 30 && says "[20/20] building release (log: build/release/build.log)"
  (
    say() { echo "merlin: $*" >&2; }
    # shellcheck source=/dev/null
    . "$top/tools/setup/build.sh"
    printf '[1/2] a\n[2/2] b\n' | show_progress "building release (log: a long name of a file that is not cut)"
  ) 2>"$world/out"
  [ "$(cat "$world/out")" = "merlin: building release (log: a long name of a file that is not cut)" ] || fail "not one plain line"
}

case_SourcesThatDoNotBuildGiveFour() {
  all_packages_there
  builds_nothing
  export MUJOCO_ROOT="$world/own"
  mkdir -p "$MUJOCO_ROOT/include/mujoco" && touch "$MUJOCO_ROOT/include/mujoco/mujoco.h" "$MUJOCO_ROOT/libmujoco.so.4.0.0"
  stand_in ninja '[ "$1" != -n ] || exit 0
printf "[1/2] Building a\n[2/2] Building b\nFAILED: b.o\n/usr/bin/c++ a long line\nb.cc:3: error: no\nninja: build stopped\n"; exit 1'
  merlin 4 doctor && says "b.cc:3: error: no"
  ! grep -q "a long line" "$world/err" || fail "the command line was shown"
}

case_NoTwinBuildsAndStartsTheProgramOfTheCar() {
  all_packages_there
  builds_nothing
  mujoco_there
  stand_in ninja 'echo "ninja $*" >>"'"$world"'/built"; mkdir -p "$PWD"; echo "ninja: no work to do."'
  merlin 7 doctor && says "program got: doctor"
  cp "$world/bin/program" "$top/build/release/tools/merlin_no_twin"
  sed -i 's/program got/program of the car got/' "$top/build/release/tools/merlin_no_twin"
  merlin 7 --no-twin run a --robot "hardware:a file.yaml" && says "program of the car got: run a --robot hardware:a file.yaml"
  grep -q ' merlin$' "$world/built" && grep -q ' merlin_no_twin$' "$world/built" || fail "another program was built"
}

# A MuJoCo that is there, so that set-up comes to the oracles.
mujoco_there() {
  export MUJOCO_ROOT="$world/own"
  mkdir -p "$MUJOCO_ROOT/include/mujoco" && touch "$MUJOCO_ROOT/include/mujoco/mujoco.h" "$MUJOCO_ROOT/libmujoco.so.4.0.0"
}
real_python=$(command -v python3)
# python3 -m venv with these lines for its pip; all else by the real one.
venv_whose_pip() { # lines
  stand_in venv_python "$1"
  stand_in python3 "[ \"\$1 \$2\" = '-m venv' ] || exec '$real_python' \"\$@\"
mkdir -p \"\$3/bin\" && cp '$world/bin/venv_python' \"\$3/bin/python\""
}

case_OraclesWithoutNetworkStopWithThree() {
  all_packages_there
  builds_nothing
  mujoco_there
  venv_whose_pip 'echo "ERROR: No matching distribution found for evo" >&2; exit 1'
  merlin 3 bench register && says "set-up stopped at the tests' oracles" && says "No matching distribution"
  one_sentence 2
  [ ! -e "$top/.deps/oracles" ] || fail "half an environment was left"
  merlin 7 bench slam
  MERLIN_ORACLES="$world/own" merlin 7 bench register
}

case_InterruptedOraclesLeaveNothingAndAreMadeOnce() {
  all_packages_there
  builds_nothing
  mujoco_there
  venv_whose_pip 'kill -INT $PPID; sleep 0.2'
  merlin 130 bench register
  [ ! -e "$top/.deps/oracles" ] || fail "half an environment was left"
  venv_whose_pip 'echo "$*" >"$(dirname "$0")/got"'
  merlin 7 bench register --json && says "program got: bench register --json"
  grep -q -- "--require-hashes .*oracles.txt" "$top/.deps/oracles/bin/got" || fail "the packages' hashes are not checked"
  venv_whose_pip 'exit 1'
  merlin 7 bench register
  echo "# another list" >>"$top/tools/setup/oracles.txt"
  merlin 3 bench register
}

"case_$case"
