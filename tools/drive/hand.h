// Limits of the operator's manual commands.
#pragma once

namespace merlin {

struct HandLimits {
  double speed_m_s = 0.8;       // (0, 2] at full stick
  double steering_rad = 0.436;  // (0, 1.5] at full stick: the limit of the car
};

}  // namespace merlin
