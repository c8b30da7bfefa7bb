#!/usr/bin/env bash
# no_twin_test.sh SOURCE_DIR: configures and builds with MERLIN_TWIN=OFF where CMake may find neither MuJoCo, Embree nor GL,
# and proves that no object read their headers and no program links their libraries. Builds into build/no-twin.
set -euo pipefail
cd "$1"
build=build/no-twin
engines='mujoco|embree|/EGL/|/GL/|osmesa'

unset MUJOCO_ROOT
[ -e $build/build.ninja ] || cmake --preset no-twin
cmake --build --preset no-twin

objects=$(find $build -name '*.o' | wc -l)
[ "$objects" -gt 0 ] && [ "$(ninja -C $build -t deps | grep -c ': #deps')" -ge "$objects" ] ||
  { echo "no record of what the objects depend on"; exit 1; }
! ninja -C $build -t deps | grep -iE "$engines" || { echo "these objects read headers of the engines"; exit 1; }

programs=$(find $build -type f -executable ! -path '*/CMakeFiles/*')
[ -n "$programs" ] || { echo "no program was built"; exit 1; }
for program in $programs; do
  ! readelf -d "$program" | grep NEEDED | grep -iE 'libmujoco|libembree|libEGL|libGL|libOSMesa' ||
    { echo "$program links an engine"; exit 1; }
done
