# shellcheck shell=bash
# Configures and builds one preset, quietly. Sourced by tools/merlin. Warnings stop the build in continuous integration (the
# variable CI) and in the presets of developers, not at a user's.

# Configures a build folder again if it was configured in another place, or for another MuJoCo or other presets.
configured() { # folder
  [ -e "$1/build.ninja" ] && grep -qxF "MUJOCO_ROOT:PATH=$mujoco_root" "$1/CMakeCache.txt" &&
    grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$top" "$1/CMakeCache.txt" && cmp -s "$top/CMakePresets.json" "$1/presets.json"
}

configure() { # preset
  local dir=$top/build/$1 log=$top/build/$1/configure.log
  ! configured "$dir" || return 0
  mkdir -p "$dir" 2>/dev/null || stop 3 "cannot write in $top/build, where it is built"
  (cd "$top" && cmake --fresh --preset "$1" "-DMUJOCO_ROOT:PATH=$mujoco_root" ${CI:+-DCMAKE_COMPILE_WARNING_AS_ERROR=ON} ${compiler:+"-DCMAKE_CXX_COMPILER=$compiler"}) >"$log" 2>&1 </dev/null || {
    grep -A 8 '^CMake Error' "$log" >&2 || tail -n 20 "$log" >&2
    rm -f "$dir/build.ninja"
    stop 3 "CMake could not configure the build (log: $log)"
  }
  cp "$top/CMakePresets.json" "$dir/presets.json"
}

build() { # preset, targets...
  local preset=$1 dir=$top/build/$1 log=$top/build/$1/build.log
  shift
  configure "$preset"
  ! ninja -n -C "$dir" "$@" 2>/dev/null | grep -q 'no work to do' || return 0
  NINJA_STATUS='[%f/%t] ' ninja -C "$dir" "$@" 2>&1 </dev/null | tee "$log" | show_progress "building $preset (log: build/$preset/build.log)" || {
    # Without ninja's status lines and the compiler's long command lines.
    awk '/^FAILED: /{command = 1; next} command{command = 0; next} !/^\[|^ninja: /' "$log" | head -n 60 >&2
    stop 4 "the sources do not build (log: $log)"
  }
}

# Shows progress: on a terminal one line that is overwritten and cut to the present width, elsewhere plain lines.
show_progress() { # what
  local line
  [ -t 2 ] || say "$1"
  while IFS= read -r line; do
    [[ -t 2 && $line =~ ^\[[0-9]+/[0-9]+\] ]] && line="merlin: ${BASH_REMATCH[0]} $1" && printf '\r\033[K%s' "${line:0:$(terminal_columns) - 1}" >&2
  done
  [ ! -t 2 ] || printf '\r\033[K' >&2
}

# The width of the terminal at stderr; if it is not known, COLUMNS or 80.
terminal_columns() {
  local size
  size=$(stty size <&2 2>/dev/null) || size=
  for size in "${size#* }" "${COLUMNS-}" 80; do [[ ! $size =~ ^[1-9][0-9]*$ ]] || break; done
  echo "$size"
}
