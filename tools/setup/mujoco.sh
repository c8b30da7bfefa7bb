# shellcheck shell=bash
# MuJoCo: its headers, library, manual and licences in .deps/mujoco, or the copy MUJOCO_ROOT names. Sourced by tools/merlin.

mujoco_version=4.0.0
mujoco_library=libmujoco.so.$mujoco_version
mujoco_root=$deps/mujoco  # what CMake is told

check_mujoco_root() {
  [ -n "${MUJOCO_ROOT-}" ] || return 0
  local file
  for file in include/mujoco/mujoco.h "$mujoco_library"; do
    [ -e "$MUJOCO_ROOT/$file" ] || [ -e "$MUJOCO_ROOT/lib/$file" ] || stop 3 "MUJOCO_ROOT=$MUJOCO_ROOT: no $file there; expected a MuJoCo $mujoco_version"
  done
  mujoco_root=$(readlink -f "$MUJOCO_ROOT")
}

# The wheel on PyPI and its SHA-256, for each kind of machine.
mujoco_sha256() {
  case $1 in
    x86_64) echo 885bd9b9cc0a6b5ba1114923eb954027652a6a0c115fa46b3218b83bae72ac4f ;;
    aarch64) echo 34de0c1674caa95abd3a0214ded4461e688150fbaa015b2db523d553b7411c3b ;;
    *) stop 3 "MuJoCo $mujoco_version is not published for $1 machines; build it and set MUJOCO_ROOT" ;;
  esac
}

# The stamp .complete is written last and the finished folder is moved into place, so that an interrupted call leaves no
# half copy.
fetch_mujoco() {
  [ -z "${MUJOCO_ROOT-}" ] || return 0
  local arch sha256 wheel log=$deps/pip.log
  arch=$(uname -m)
  sha256=$(mujoco_sha256 "$arch")
  [ "$(cat "$mujoco_root/.complete" 2>/dev/null)" != "$sha256" ] || return 0
  say "fetching MuJoCo $mujoco_version (10 MB, the simulation's physics) from PyPI into $mujoco_root"
  rm -rf "$deps"/.fetch.*
  fetched=$(mktemp -d "$deps/.fetch.XXXXXX")
  trap 'rm -rf "$fetched"' EXIT
  pip download --quiet --disable-pip-version-check --retries 2 --dest "$fetched" --no-deps --only-binary=:all: \
    --python-version 3.11 --platform "manylinux_2_28_$arch" "mujoco-core==$mujoco_version" >"$log" 2>&1 </dev/null ||
    stop 3 "set-up stopped at fetching MuJoCo: pip could not download mujoco-core $mujoco_version (its words: $log); no network?"
  wheel=$(echo "$fetched"/*.whl)
  [ "$(sha256sum <"$wheel")" = "$sha256  -" ] ||
    stop 3 "set-up stopped at fetching MuJoCo: the SHA-256 of $(basename "$wheel") is not the expected $sha256; deleted"
  unpack_mujoco "$wheel" "$sha256" || stop 3 "set-up stopped at unpacking MuJoCo into $mujoco_root; disk full?"
  rm -rf "$fetched"
  trap - EXIT
}

unpack_mujoco() { # wheel, sha256
  local whole=$fetched/wheel chosen=$fetched/mujoco
  python3 -m zipfile -e "$1" "$whole" &&
    mkdir "$chosen" &&
    mv "$whole"/mujoco/{include,doc,"$mujoco_library"} "$chosen" &&
    mv "$whole"/mujoco_core-*.dist-info/licenses "$chosen" &&
    echo "$2" >"$chosen/.complete" &&
    { [ ! -e "$mujoco_root" ] || mv "$mujoco_root" "$fetched/former"; } &&
    mv -T "$chosen" "$mujoco_root"
}
