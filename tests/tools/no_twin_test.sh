#!/usr/bin/env bash
# no_twin_test.sh BUILD_DIR PROGRAM: the program without the twin links no engine, and none of the objects that it is made
# of read an engine's header. The build may hold the twin, too. (`merlin test --all` builds the preset no-twin, where CMake
# finds no engine at all.)
set -euo pipefail
build=$1 program=$2
engines='mujoco|embree|/EGL/|/GL/|osmesa'

! readelf -d "$program" | grep NEEDED | grep -iE 'libmujoco|libembree|libEGL|libGL|libOSMesa' ||
  { echo "$program links an engine"; exit 1; }

objects=$(ninja -C "$build" -t inputs "$(realpath --relative-to="$build" "$program")" | grep '\.o$')
[ "$(echo "$objects" | grep -c .)" -gt 20 ] || { echo "these are not the objects that $program is made of: $objects"; exit 1; }
# shellcheck disable=SC2086
read=$(ninja -C "$build" -t deps $objects)
[ "$(echo "$read" | grep -c ': #deps')" -ge "$(echo "$objects" | wc -l)" ] || { echo "no record of what the objects depend on"; exit 1; }
! echo "$read" | grep -iE "$engines" || { echo "these objects read headers of the engines"; exit 1; }
"$program" --version
