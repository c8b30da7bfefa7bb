// The attitude sensor: true attitude plus noise.
#pragma once

#include <cstdint>

#include "robot/types/measurements.h"
#include "robot/types/se3.h"

namespace merlin::sim {

struct CompassConfig {
  double yaw_noise_rad = 0.0087;   // one sigma, [0, 0.2]; 0.5 deg (0.3-1 deg, guess)
  double tilt_noise_rad = 0.0087;  // roll and pitch, one sigma, [0, 0.2]; same
};

template <class Visitor>
void Visit(Visitor& v, CompassConfig& c) {
  v("yaw_noise_rad", c.yaw_noise_rad, {0.0, 0.2});
  v("tilt_noise_rad", c.tilt_noise_rad, {0.0, 0.2});
}

// The index-th reading. All three angles in (-pi, pi]. Nose straight up or down (pitch +-pi/2) roll and yaw are not
// defined, as on any such sensor.
CompassReading ReadCompass(const Pose& T_world_base, const CompassConfig& config, std::uint64_t seed, Time stamp,
                           std::uint64_t index);

}  // namespace merlin::sim
