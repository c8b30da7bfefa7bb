// The attitude sensor: the true attitude plus noise. Steel nearby bends the magnetic field, and so the yaw.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/types/measurements.h"
#include "robot/types/se3.h"
#include "robot/types/steel.h"

namespace merlin::sim {

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
