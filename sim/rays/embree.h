// Embree's header by one name, of the version that CMake chose: 3 (Debian 12) or 4 (Debian 13). The two differ in how a
// query is described; ray_scene.cc holds what follows from that.
#pragma once

#if MERLIN_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
