// The attitude sensor: the true attitude plus noise. Steel nearby bends the magnetic field, and so the yaw.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/types/measurements.h"
#include "robot/types/se3.h"

namespace merlin::sim {

// Steel in a wall or floor: it turns the field around it, most at its own place, by exp(-1/2 (distance / reach)^2).
struct Steel {
  double x_m = 0.0, y_m = 0.0;  // in the room's frame
  double reach_m = 1.0;         // [0.05, 100]
  double bend_rad = 0.2;  // [-3, 3] of the heading at its own place; corridors of reinforced concrete: 2-20 deg (guess)
};

template <class Visitor>
void Visit(Visitor& v, Steel& c) {
  v("x_m", c.x_m, {-1e4, 1e4});
  v("y_m", c.y_m, {-1e4, 1e4});
  v("reach_m", c.reach_m, {0.05, 100.0});
  v("bend_rad", c.bend_rad, {-3.0, 3.0});
}

struct CompassConfig {
  double yaw_noise_rad = 0.0087;   // one sigma, [0, 0.2]; 0.5 deg (0.3-1 deg, guess)
  double tilt_noise_rad = 0.0087;  // roll and pitch, one sigma, [0, 0.2]; same
  std::vector<Steel> steel{};
};

// What steel adds to the yaw there [rad].
double BendAt(const std::vector<Steel>& steel, double x_m, double y_m);

// The index-th reading. All three angles in (-pi, pi]. With the nose straight up or down (pitch +-pi/2) roll and yaw
// are not defined, as on any such sensor.
CompassReading ReadCompass(const Pose& T_world_base, const CompassConfig& config, std::uint64_t seed, Time stamp,
                           std::uint64_t index);

}  // namespace merlin::sim
