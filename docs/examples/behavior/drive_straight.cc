#include "docs/examples/behavior/drive_straight.h"

namespace merlin {

Intent DriveStraight::Decide(const Situation& situation) {
  constexpr double kStep_m = 0.1, kBeyond_m = 0.5;
  if (!T_map_start_) T_map_start_ = *situation.T_map_base;
  const double driven_m = (T_map_start_->inverse() * *situation.T_map_base).translation().x();

  Intent intent;
  intent.done = driven_m >= config_.length_m;
  if (intent.done) return intent;  // its speed is 0: the car stops
  intent.activity = Activity::kFollowsPath;
  intent.doing = "drives straight ahead";
  intent.speed_m_s = config_.speed_m_s;
  // The pilot halts at a path's end, so this one goes on a little.
  for (double x_m = 0.0; x_m < config_.length_m + kBeyond_m; x_m += kStep_m)
    intent.path_map.push_back((*T_map_start_ * Eigen::Vector3d(x_m, 0.0, 0.0)).head<2>());
  return intent;
}

}  // namespace merlin
