#include "autonomy/look_around.h"

#include <algorithm>

namespace merlin {

LookAround::Range LookAround::RangeFor(const Observation& observation, const std::optional<PathAcross>& across,
                                       bool lost) const {
  // Directions that must be seen: those of the path, and around its middle those that registration needs.
  double right_rad = 0.0, left_rad = 0.0;
  if (across) {
    const auto bearing = [&](const Eigen::Vector2d& point_base) {
      const Eigen::Vector2d ray = point_base - observation.camera_base.head<2>().cast<double>();
      return std::atan2(ray.y(), ray.x());
    };
    right_rad = bearing(across->front());
    left_rad = bearing(across->back());
  }
  const double middle_rad = 0.5 * (right_rad + left_rad);
  const double half_rad =
      std::max(0.5 * (left_rad - right_rad), std::max(config_.half_view_rad, lost ? config_.half_view_lost_rad : 0.0));
  const double turn_rad = std::max(0.0, half_rad - observation.half_view_rad);
  const double min_rad = car_.links[car_.pan->link].joint_min_rad, max_rad = car_.links[car_.pan->link].joint_max_rad;
  return {std::clamp(middle_rad - turn_rad, min_rad, max_rad), std::clamp(middle_rad + turn_rad, min_rad, max_rad)};
}

double LookAround::Step_rad(const Observation& observation) const {
  return std::min(config_.step_share * 2.0 * observation.half_view_rad,
                  config_.moving_share * car_.pan->slew_rad_s * frame_s_);
}

std::optional<double> LookAround::Next_rad(const Observation& observation, const std::optional<PathAcross>& across,
                                           bool lost) {
  if (!observation.pans || !car_.pan) return std::nullopt;
  if (last_stamp_) frame_s_ = Seconds(observation.stamp - *last_stamp_);
  last_stamp_ = observation.stamp;
  // One frame sees all that a sweep would.
  if (observation.half_view_rad >= config_.half_view_rad - 1e-3 && !lost) return angle_rad_ = period_s_ = 0.0;
  const Range range = RangeFor(observation, across, lost);
  const double step_rad = Step_rad(observation);
  if (step_rad <= 0.0) return angle_rad_;
  period_s_ = 2.0 * std::ceil((range.left_rad - range.right_rad) / step_rad) * frame_s_;
  angle_rad_ += side_ * step_rad;
  if (angle_rad_ >= range.left_rad) angle_rad_ = std::max(range.left_rad, angle_rad_ - 2.0 * step_rad), side_ = -1.0;
  if (angle_rad_ <= range.right_rad) angle_rad_ = std::min(range.right_rad, angle_rad_ + 2.0 * step_rad), side_ = 1.0;
  return angle_rad_;
}

}  // namespace merlin
