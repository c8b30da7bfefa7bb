#include "perception/odometry.h"

#include <algorithm>
#include <cmath>

#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/motion.h"

namespace merlin {
namespace {

constexpr Duration kHistory = std::chrono::seconds(1);

}  // namespace

void Odometry::Update(const DriveState& state) {
  Pose T_odom_base = knots_.empty() ? Pose::Identity() : knots_.back().T_odom_base;
  if (last_) {
    const double wheels_rad = WheelsAngle_rad(car_, 0.5 * (last_->steering_rad + state.steering_rad));
    const double path_m = Path_m(car_, state.encoder_counts - last_->encoder_counts, wheels_rad);
    T_odom_base = T_odom_base * ArcMotion(path_m, Turn_rad(car_, path_m, wheels_rad));
  }
  last_ = state;
  knots_.push_back({state.stamp, T_odom_base});
  while (knots_.front().stamp + kHistory < state.stamp) knots_.pop_front();
}

std::optional<Pose> Odometry::At(Time time) const {
  if (knots_.empty()) return std::nullopt;
  const auto after =
      std::lower_bound(knots_.begin(), knots_.end(), time, [](const Knot& knot, Time t) { return knot.stamp < t; });
  if (after == knots_.begin()) return knots_.front().T_odom_base;
  if (after == knots_.end()) return knots_.back().T_odom_base;
  const auto before = std::prev(after);
  return Interpolate(before->T_odom_base, after->T_odom_base,
                     Seconds(time - before->stamp) / Seconds(after->stamp - before->stamp));
}

}  // namespace merlin
