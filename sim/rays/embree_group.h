// A RayGroup in Embree: triangles as triangle geometries, curved geoms as user geometries intersected by MuJoCo.
#pragma once

#include <memory>

#include "sim/rays/embree.h"
#include "sim/rays/ray_group.h"

namespace merlin::sim {
constexpr unsigned kOpaqueMask = 1, kPaneMask = 2;

// Embree's ids of the geometries of group g in any scene: 2 g for triangles, 2 g + 1 for curved geoms.
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

// Adds the group's geometries, with these ids and in the group's frame, to the scene. Embree keeps the group's address.
void Attach(RTCDevice device, RTCScene scene, const RayGroup& group, unsigned number);

}  // namespace merlin::sim
