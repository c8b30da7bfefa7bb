# shellcheck shell=bash
# The tests' oracles: Python packages that tests and `bench register` compare merlin with, in a virtual environment of
# their own, .deps/oracles. MERLIN_ORACLES names another one, which is used as it is. Sourced by tools/merlin.

oracles=$(readlink -m "${MERLIN_ORACLES:-$deps/oracles}")
oracle_list=$tools/setup/oracles.txt

# An environment is valid for one list of packages, one place (its programs contain the path of their interpreter) and
# one Python.
oracle_stamp() { echo "$(sha256sum <"$oracle_list") $oracles $(python3 -c 'import sys; print(sys.version)')"; }

# The stamp .complete is written last. An environment without it, or with a different one, is made again.
install_oracles() {
  local stamp log=$deps/oracles.log
  [ -z "${MERLIN_ORACLES-}" ] || { export MERLIN_ORACLES=$oracles && return 0; }
  stamp=$(oracle_stamp)
  [ "$(cat "$oracles/.complete" 2>/dev/null)" != "$stamp" ] || return 0
  say "fetching the tests' oracles (95 MB: evo, small_gicp and what they need) from PyPI into $oracles"
  trap 'rm -rf "$oracles"' EXIT
  rm -rf "$oracles"
  {
    python3 -m venv "$oracles" &&
      "$oracles/bin/python" -m pip install --quiet --disable-pip-version-check --retries 2 --no-cache-dir \
        --no-deps --only-binary=:all: --require-hashes -r "$oracle_list"
  } >"$log" 2>&1 </dev/null ||
    stop 3 "set-up stopped at the tests' oracles: $(oracle_reason "$log"); no network? MERLIN_ORACLES may name an environment that has them"
  echo "$stamp" >"$oracles/.complete" || stop 3 "set-up stopped at the tests' oracles: cannot write in $oracles; disk full?"
  trap - EXIT
}

oracle_reason() { grep -m 1 '^ERROR: ' "$1" || echo "python3 -m venv or pip failed (log: $1)"; }
