// A RayGroup as Embree takes it: triangles as they are, curved geoms as user geometries that MuJoCo intersects.
#pragma once

#include <memory>

#include "sim/rays/embree.h"
#include "sim/rays/ray_group.h"

namespace merlin::sim {
constexpr unsigned kOpaqueMask = 1, kPaneMask = 2;

// Embree's numbers of the g-th group's geometries, in whichever scene they are: 2 g for triangles, 2 g + 1 for curved ones.
constexpr unsigned TrianglesId(unsigned group) { return 2 * group; }
constexpr unsigned CurvedId(unsigned group) { return 2 * group + 1; }
constexpr bool IsCurved(unsigned id) { return id % 2 == 1; }
constexpr unsigned GroupOf(unsigned id) { return id / 2; }

inline unsigned MaskOf(const RayGroup& group) { return group.panes ? kPaneMask : kOpaqueMask; }

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, EmbreeRelease>;
using EmbreeGeometry = std::unique_ptr<RTCGeometryTy, EmbreeRelease>;

EmbreeScene NewScene(RTCDevice device, RTCSceneFlags flags);

// Adds the group's geometries to the scene by their numbers, in the group's frame. Embree keeps the group's address.
void Attach(RTCDevice device, RTCScene scene, const RayGroup& group, unsigned number);

}  // namespace merlin::sim
