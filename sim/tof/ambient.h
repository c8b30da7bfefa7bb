// Light that is not the lamp's: sun through windows, sky, lamps of the room.
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

// Spectral irradiance [W/m2/nm] of each point: the room's own, the sun where it reaches (a pane in its way takes its
// part), and the sky through each window.
std::vector<float> Irradiance(const RayScene& scene, const Surroundings& around, std::span<const LitPoint> points);

// Albedo times irradiance as each pixel sees it [W/m2/nm], the light by way of panes and mirrors included.
std::vector<float> AmbientOfPixels(const RayScene& scene, const Surroundings& around, const Optics& optics,
                                   const MidHits& mid, std::span<const ExtraReturn> extra, int threads);

// [sub-ray] bit b: something stands between board b and what the sub-ray meets.
std::vector<std::uint8_t> LampShadows(const RayScene& scene, const Optics& optics, const MidHits& mid, int threads);

}  // namespace merlin::sim
