# shellcheck shell=bash
# `merlin test`: builds and runs the tests: those of one name, the suite, or everything. Sourced by tools/merlin.

parse_test_arguments() {
  test_name='' test_all=''
  case $#:${1-} in
    0:) ;;
    1:-h | 1:--help) cat "$tools/cli/help.txt" && exit 0 ;;
    1:--all) test_all=1 ;;
    2:-R) test_name=$2 ;;
    *) stop 2 "test takes nothing, -R NAME, or --all; got: $*" ;;
  esac
}

run_tests() {
  passed=0 failed=0 skipped=0 times=''
  install_oracles
  if [ -n "$test_name" ]; then
    timed "release build" build release all unit_tests
    unlock
    require_test_named "$test_name"
    timed "tests" run_ctest release -R "$test_name"
  elif [ -n "$test_all" ]; then
    test_everything
  else
    test_suite
  fi
  say "times: ${times%, }"
  echo "$passed passed, $failed failed, $skipped skipped"
  [ "$failed" = 0 ]
}

# Runs every test once (tests/CMakeLists.txt says where): tests that drive, draw or compute much in the release build,
# all others under the sanitizers.
test_suite() {
  timed "release build" build release
  unlock
  timed "release tests" run_ctest release -L '^(numeric|loop|real_time|setup)$'
  lock
  timed "sanitizer build" build asan unit_tests
  unlock
  timed "sanitizer tests" run_ctest asan -L '^unit$'
}

# Runs a step and notes how long it took.
timed() { # name, command...
  local name=$1 start=$SECONDS
  shift
  "$@"
  times+="$name $((SECONDS - start)) s, "
}

# Runs a test preset and adds its counts. If it fails without a failed test (none found, for example), that counts as
# one failure.
run_ctest() { # preset, more arguments of ctest...
  local preset=$1 report=$top/build/$1/tests.xml bad=0 counts
  shift
  rm -f "$report"
  say "running the tests of $preset"
  (cd "$top" && ctest --preset "$preset" --parallel "$(nproc)" --output-junit "$report" "$@") </dev/null || bad=1
  counts=$(junit_counts "$report") || counts="0 0 0"
  read -r total broken left_out <<<"$counts"
  ((bad == 0 || broken > 0)) || { broken=1 && total=$((total + 1)); }
  ((passed += total - broken - left_out, failed += broken, skipped += left_out)) || true
}

# tests, failures, disabled and skipped of a JUnit file
junit_counts() {
  python3 - "$1" <<'PYTHON'
import sys, xml.etree.ElementTree as tree
suite = tree.parse(sys.argv[1]).getroot()
print(suite.get("tests"), suite.get("failures"), int(suite.get("disabled")) + int(suite.get("skipped")))
PYTHON
}

test_names() { (cd "$top" && ctest --preset release -N "$@" 2>/dev/null || true) | sed -n 's/^ *Test *#[0-9]*: //p'; }

require_test_named() {
  local close
  [ -z "$(test_names -R "$1")" ] || return 0
  close=$(python3 - "$1" "$(test_names)" <<'PYTHON'
import difflib, sys
name, names = sys.argv[1].lower(), sys.argv[2].split("\n")
short = {part.lower(): full for full in names for part in [full, *full.split(".")]}
close = [full for full in names if name in full.lower()]
close += [short[part] for part in difflib.get_close_matches(name, short, n=6, cutoff=0.5)]
print(", ".join(list(dict.fromkeys(close))[:5]))
PYTHON
  )
  stop 2 "no test is named '$1'${close:+; close to it: $close}"
}
