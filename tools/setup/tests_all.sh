# shellcheck shell=bash
# `merlin test --all`: the tests that take too long for every change. Sourced by tools/merlin; steps and counts as in
# tests.sh.

test_everything() {
  local clang
  clang=$(oldest_clang)
  [ -n "$clang" ] || stop 3 "no package clang-16 or newer is known here, which builds and fuzzes everything a second time (apt-get update?)"
  # shellcheck disable=SC2046
  install_packages $(sed 's/#.*//' "$tools/setup/packages-all-debian.txt") "clang-$clang" "libclang-rt-$clang-dev"
  timed "release build" build release all unit_tests
  unlock
  timed "release tests" run_ctest release
  timed "scenarios" run_scenarios
  timed "clang-format" check_format
  timed "no-twin build" count "the preset no-twin builds" build_alone no-twin
  timed "clang build" count "clang builds everything" build_with "clang++-$clang" clang all unit_tests
  timed "fuzzing" run_fuzzers
  timed "thread sanitizer build" build_alone tsan thread_tests
  timed "thread sanitizer tests" run_ctest tsan
  timed "sanitizer build" build_alone asan-all unit_tests numeric_tests
  timed "sanitizer tests" run_ctest asan-all -L '^(unit|numeric)$'
}

# clang before 16 rejects some of the ranges in GCC 12's library. Of the others the oldest is used, because security
# updates bring newer ones, whose new warnings would break an unchanged build.
oldest_clang() {
  apt-cache search --names-only '^clang-[0-9]+$' | sed -n 's/^clang-\([0-9]*\) .*/\1/p' | awk '$1 >= 16' | sort -n | head -n 1
}

build_alone() { # as build
  lock
  build "$@"
  unlock
}

build_with() { # compiler, as build
  local compiler=$1
  shift
  build_alone "$@"
}

# One command is one test. If a build fails, the script has already stopped.
count() { # name, command...
  local name=$1
  shift
  if "$@"; then
    ((passed += 1))
  else
    say "FAILED: $name"
    ((failed += 1))
  fi
}

# Every scenario completely, on three seeds; corridor_loop must have colour.
run_scenarios() {
  local scenario seed name
  for scenario in "$top"/scenarios/*.yaml; do
    name=$(basename "$scenario" .yaml)
    for seed in 1 2 3; do
      count "$name on seed $seed" run_scenario "$name" "$seed"
    done
  done
}

run_scenario() { # name, seed
  local out=$top/build/scenarios/$1-$2
  mkdir -p "$top/build/scenarios"
  say "running $1 on seed $2"
  "$top/build/release/tools/merlin" run "$1" --seed "$2" --out "$out" >"$out.log" 2>&1 </dev/null ||
    { tail -n 20 "$out.log" >&2; return 1; }
  [ "$1" != corridor_loop ] || grep -Eq '"color": "[0-9a-f]{64}"' "$out/result.json" || { say "$out: no colour"; return 1; }
}

# Each target for a minute, two at a time. The bug planted in its decoder must be found as well.
run_fuzzers() {
  local folder=$top/build/fuzz/tests/fuzz target
  build_with "clang++-$clang" fuzz fuzz_targets
  for target in "$folder"/fuzz_*; do
    [[ -x $target && -f $target && $target != *_planted ]] || continue
    echo "$target"
  done | xargs -P "$(nproc)" -I{} bash -c '"$1" -max_total_time=60 -print_final_stats=1 -artifact_prefix="$1-" >"$1.log" 2>&1 </dev/null || echo "$1" >"$1.failed"' _ {}
  for target in "$folder"/fuzz_*; do
    [[ -x $target && -f $target ]] || continue
    if [[ $target = *_planted ]]; then
      count "$(basename "$target") finds its bug" finds_the_bug "$target"
    else
      count "$(basename "$target") survives a minute" test ! -e "$target.failed"
    fi
    rm -f "$target.failed"
  done
}

finds_the_bug() { # program
  ! (cd "$(dirname "$1")" && timeout 300 "$1" -max_total_time=240 >"$1.log" 2>&1 </dev/null)
  grep -qE 'ERROR: (libFuzzer|AddressSanitizer)|runtime error' "$1.log"
}

# The style is that of clang-format in Debian 12; other versions differ in details.
check_format() {
  if [[ $(clang-format --version) != *"version 14."* ]]; then
    say "skipped: the format is checked with Debian 12's clang-format (14); here: $(clang-format --version)"
    ((skipped += 1))
    return
  fi
  count "the sources are formatted" formatted
}

formatted() {
  (cd "$top" && git ls-files '*.cc' '*.h' | xargs clang-format --dry-run -Werror 2>&1 | grep -m 20 'error:') && return 1 || return 0
}
