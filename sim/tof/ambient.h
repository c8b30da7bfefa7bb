// Light that does not come from the camera's lamp: the sun through windows, the sky, the room's own lamps. It carries
// no modulation; it adds electrons, and with them noise and saturation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/tof/hits.h"
#include "sim/tof/returns.h"
#include "sim/tof/surroundings.h"

namespace merlin::sim {

struct LitPoint {
  Eigen::Vector3f point{0, 0, 0};   // world
  Eigen::Vector3f normal{0, 0, 1};  // unit
};

// Spectral irradiance [W/m2/nm] of each point: the room's own light, the sun if it reaches the point (attenuated by
// panes), and the sky through each window.
std::vector<float> Irradiance(const RayScene& scene, const Surroundings& around, std::span<const LitPoint> points);

// Albedo times irradiance for each pixel [W/m2/nm], including light through panes and from mirrors.
std::vector<float> AmbientOfPixels(const RayScene& scene, const Surroundings& around, const Optics& optics,
                                   const MidHits& mid, std::span<const ExtraReturn> extra, int threads);

// For each sub-ray: bit b is set if something is between board b and what the sub-ray hits.
std::vector<std::uint8_t> LampShadows(const RayScene& scene, const Optics& optics, const MidHits& mid, int threads);

}  // namespace merlin::sim
