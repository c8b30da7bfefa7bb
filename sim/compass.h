// The simulated attitude sensor: true attitude plus noise. Steel nearby distorts the magnetic field, and so the yaw.
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

// The yaw error that steel causes at a position in the world frame [rad].
double BendAt(const std::vector<Steel>& steel, double x_m, double y_m);

// The reading with this index (which selects its noise). All angles are in (-pi, pi]. At a pitch of +-pi/2 roll and yaw
// are undefined, as with any such sensor.
CompassReading ReadCompass(const Pose& T_world_base, const CompassConfig& config, std::uint64_t seed, Time stamp,
                           std::uint64_t index);

}  // namespace merlin::sim
