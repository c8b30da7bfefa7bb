#include "autonomy/behaviors/turn_on_turntable.h"

#include <cmath>

namespace merlin {
namespace {

// The odometry on a turntable follows its measured angle, which reaches the target exactly.
constexpr double kArrived_rad = 1e-3;

}  // namespace

Intent TurnOnTurntable::Decide(const Situation& situation) {
  const double yaw_rad = Yaw(situation.observation.T_odom_base);
  turned_rad_ += WrapPi(yaw_rad - last_yaw_rad_.value_or(yaw_rad));
  last_yaw_rad_ = yaw_rad;

  Intent intent;
  intent.done = std::abs(turned_rad_ - config_.angle_rad) < kArrived_rad;
  intent.activity = intent.done ? Activity::kIsDone : Activity::kTurnsOnTurntable;
  intent.turntable_rad = config_.angle_rad;
  return intent;
}

}  // namespace merlin
