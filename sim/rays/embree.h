// Embree's header of the version that CMake found: 3 (Debian 12) or 4 (Debian 13). The two describe a query
// differently; ray_scene.cc handles this.
#pragma once

#if MERLIN_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
