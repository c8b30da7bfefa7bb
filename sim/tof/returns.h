// Light that reaches a pixel through a pane or from a mirror: what is behind the pane, what is mirrored, the lamp
// itself.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/types/depth_camera_errors.h"
#include "sim/tof/effects.h"
#include "sim/tof/hits.h"
#include "sim/tof/optics.h"
#include "sim/tof/surroundings.h"

namespace merlin::sim {

// One further return of a sub-ray, traced at mid-exposure. In a sub-frame it lies beyond_m behind what the sub-ray hits
// then, as long as that is the same geom.
struct ExtraReturn {
  std::size_t sub_ray = 0;
  int geom = -1;               // the pane or mirror
  float beyond_m = 0.0f;       // length of the path beyond the pane or mirror
  float strength = 0.0f;       // electrons = K T / sub-rays strength / length^2
  float ambient_share = 0.0f;  // share of the ambient light there that reaches the lens
  RayHit hit{};                // the surface there
  Eigen::Vector3f point{0, 0, 0};
};

// Reflectance of a pane's two faces together at this cosine of incidence (Fresnel; for each polarisation R + R (1 -
// R)^2 + ... = 2 R / (1 + R), their mean taken), and what passes, absorption included.
struct PaneOptics {
  double reflected = 0.0, passed = 0.0;
};
PaneOptics PaneAt(double cosine, double glass_transmission);

// For the whole image, in order of sub-rays.
std::vector<ExtraReturn> TraceReturns(const RayScene& scene, const Surroundings& around, const Optics& optics,
                                      const MidHits& mid, const DepthCameraErrors& errors, const TofEffects& effects);

// Albedo towards the lamp [geom].
std::vector<float> LampAlbedos(const Surroundings& around, const TofEffects& effects);

}  // namespace merlin::sim
