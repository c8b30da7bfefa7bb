// Light that reaches a pixel after one bounce. Surfaces that the lamp lights become many virtual lights, as in
// reflective shadow maps; each of them lights what the pixels see, unless something is in between. Their light has
// travelled farther than the direct light, so corners read too far. Source: Bulczak, Lambers, Kolb, "Quantified,
// interactive simulation of AMCW ToF camera including multipath effects", Sensors 18(1) 13 (2018).
#pragma once

#include <span>
#include <vector>

#include "sim/tof/phasors.h"

namespace merlin::sim {

struct MultipathGrid {
  int lights_x = 16, lights_y = 8;  // virtual lights over what the lamp lights
  int receivers_across = 16;        // pixels computed across the image, evenly spaced; the others are interpolated
};

// One bounce for every pixel, for K T of 1 and an albedo of 1 at the pixel's surface. A pixel gets this times its
// albedo, lens factor and K T, with phases turned by the path back to the lens (half the phase of its own range).
// Computed at mid-exposure.
std::vector<Phasors> OneBounce(const RayScene& scene, const Optics& optics, const MidHits& mid,
                               std::span<const float> albedo, double wave_number_rad_per_m, const MultipathGrid& grid,
                               int threads);

}  // namespace merlin::sim
