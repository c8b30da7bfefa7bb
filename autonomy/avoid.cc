#include "autonomy/avoid.h"

#include <algorithm>
#include <cmath>

#include "robot/kinematics/limits.h"

namespace merlin {

std::optional<double> Avoid::SeenNow_m(const Observation& observation,
                                       std::span<const Eigen::Vector2d> path_base) const {
  const auto ahead = [this](const Eigen::Vector3f& d) {
    return std::abs(std::atan2(d.y(), d.x())) < config_.saturated_half_angle_rad;
  };
  if (std::ranges::count_if(observation.saturated_base, ahead) >= config_.saturated_min) return 0.0;

  std::vector<double> obstacles_m;
  for (const Point& point : observation.points_base) {
    if (point.position.z() < config_.height_min_m || point.position.z() > config_.height_max_m) continue;
    if (const auto distance_m = DistanceUntilTouch_m(point.position.head<2>().cast<double>(), path_base))
      obstacles_m.push_back(*distance_m);
  }
  if (static_cast<int>(obstacles_m.size()) < config_.points_min) return std::nullopt;
  const auto nth = obstacles_m.begin() + (config_.points_min - 1);  // nearer ones may be noise
  std::nth_element(obstacles_m.begin(), nth, obstacles_m.end());
  return *nth;
}

std::optional<double> Avoid::DistanceUntilTouch_m(const Eigen::Vector2d& point_base,
                                                  std::span<const Eigen::Vector2d> path_base) const {
  const double half_width_m = footprint_.half_width_m + config_.margin_m;
  double driven_m = 0.0;
  for (std::size_t i = 0; i + 1 < path_base.size(); ++i) {
    const Eigen::Vector2d step = path_base[i + 1] - path_base[i];
    const double length_m = step.norm();
    if (length_m == 0.0) continue;
    const Eigen::Vector2d along = step / length_m, offset = point_base - path_base[i];
    const double ahead_m = along.dot(offset), left_m = along.x() * offset.y() - along.y() * offset.x();
    if (std::abs(left_m) <= half_width_m && ahead_m >= 0.0 && ahead_m <= footprint_.front_m + length_m)
      return driven_m + std::max(0.0, ahead_m - footprint_.front_m);
    driven_m += length_m;
  }
  return std::nullopt;
}

std::optional<double> Avoid::FreeDistance_m(const Observation& observation,
                                            std::span<const Eigen::Vector2d> path_base) {
  if (std::abs(observation.view_yaw_rad) > config_.aside_max_rad) return 0.0;
  const std::optional<double> free_m = SeenNow_m(observation, path_base);
  if (!free_m && last_ && Seconds(observation.stamp - last_->stamp) <= config_.hold_s) {
    const double driven_m = (last_->T_odom_base.inverse() * observation.T_odom_base).translation().norm();
    return std::max(0.0, last_->free_m - driven_m);
  }
  if (free_m) last_ = Memory{observation.stamp, observation.T_odom_base, *free_m};
  return free_m;
}

double Avoid::SpeedLimit_m_s(std::optional<double> free_m) const {
  if (!free_m) return HUGE_VAL;
  return SpeedToStopWithin_m_s(*free_m - config_.stop_gap_m, config_.deceleration_m_s2);
}

}  // namespace merlin
