#include "sim/world/turntable.h"

#include <algorithm>
#include <cmath>

namespace merlin::sim {

void Turntable::Send(double angle_rad) {
  if (std::isfinite(angle_rad)) target_rad_ = angle_rad;
}

void Turntable::Step(Duration duration) {
  const double step_rad = rate_rad_s_ * Seconds(duration);
  const double moved_rad = std::clamp(target_rad_ - angle_rad_, -step_rad, step_rad);
  angle_rad_ += moved_rad;
  speed_rad_s_ = moved_rad / Seconds(duration);
}

}  // namespace merlin::sim
