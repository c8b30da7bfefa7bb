// Light that reaches a pixel after one bounce. The surfaces that the lamp lights are treated as many small lamps
// themselves (virtual lights, as in reflective shadow maps): each lights what the pixels see, unless something is between.
// Their light has travelled farther than the direct light, so corners read too far. Bulczak, Lambers, Kolb, "Quantified, interactive simulation of AMCW ToF camera including
// multipath effects", Sensors 18(1) 13 (2018).
#pragma once

#include <span>
#include <vector>

#include "sim/tof/phasors.h"

namespace merlin::sim {

struct MultipathGrid {
  int lights_x = 16, lights_y = 8;  // virtual lights over what the lamp lights
  int receivers_across = 16;        // pixels, evenly over the picture's width, that are computed; the others in between
};

// One bounce, for every pixel, for an albedo of 1 there and K T of 1: what a pixel gets is this times its albedo, lens,
// K T, its phases turned by the path back to the lens (half the phase of the pixel's own range). Taken at mid-exposure.
std::vector<Phasors> OneBounce(const RayScene& scene, const Optics& optics, const MidHits& mid,
                               std::span<const float> albedo, double wave_number_rad_per_m, const MultipathGrid& grid,
                               int threads);

}  // namespace merlin::sim
