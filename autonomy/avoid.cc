#include "autonomy/avoid.h"

#include <algorithm>
#include <cmath>

#include "robot/kinematics/limits.h"

namespace merlin {

namespace {

// What is left of the free distance, once the car has driven on.
std::optional<double> Remaining_m(std::optional<double> free_m, const Pose& T_odom_then, const Pose& T_odom_now) {
  if (!free_m) return std::nullopt;
  return std::max(0.0, *free_m - (T_odom_then.inverse() * T_odom_now).translation().norm());
}

}  // namespace

bool Avoid::SaturatesAhead(const Observation& observation) const {
  const auto ahead = [this](const Eigen::Vector3f& d) {
    return std::abs(std::atan2(d.y(), d.x())) < config_.saturated_half_angle_rad;
  };
  const auto count = std::ranges::count_if(observation.saturated_base, ahead);
  return count > 0 && static_cast<double>(count) * observation.pixel_sr >= config_.saturated_min_sr;
}

std::optional<double> Avoid::SeenNow_m(std::span<const Point> points_base,
                                       std::span<const Eigen::Vector2d> path_base) const {
  std::vector<double> obstacles_m;
  for (const Point& point : points_base) {
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
  if (observation.pans) {
    seen_.Add(observation, config_.height_min_m, config_.height_max_m);
    if (!path_base.empty()) {
      const SeenAhead::Age age = seen_.OldestLook(PathToLookAt(path_base));
      if (age.time_s > config_.aside_max_s || age.driven_m > config_.aside_max_m) return 0.0;
    }
  }
  std::optional<double> free_m =
      observation.pans ? SeenNow_m(seen_.PointsBase(), path_base) : SeenNow_m(observation.points_base, path_base);
  if (SaturatesAhead(observation)) return WhileSaturated_m(observation, free_m);
  if (free_m)
    last_ = Memory{observation.stamp, observation.T_odom_base, free_m};
  else if (Holds(last_, observation.stamp))
    free_m = Remaining_m(last_->free_m, last_->T_odom_base, observation.T_odom_base);
  measured_ = Memory{observation.stamp, observation.T_odom_base, free_m};
  return free_m;
}

PathAcross Avoid::PathToLookAt(std::span<const Eigen::Vector2d> path_base) const {
  return AcrossPath(path_base, footprint_.front_m + 1.5 * config_.stop_gap_m,
                    footprint_.half_width_m + config_.margin_m);
}

bool Avoid::Holds(const std::optional<Memory>& memory, Time now) const {
  return memory && Seconds(now - memory->stamp) <= config_.hold_s;
}

// The nearer of what this frame sees and what the last one without saturated pixels saw.
std::optional<double> Avoid::WhileSaturated_m(const Observation& observation, std::optional<double> seen_m) const {
  if (observation.shortest_exposure || !Holds(measured_, observation.stamp)) return 0.0;
  const auto left_m = Remaining_m(measured_->free_m, measured_->T_odom_base, observation.T_odom_base);
  if (!left_m || !seen_m) return left_m ? left_m : seen_m;
  return std::min(*left_m, *seen_m);
}

double Avoid::SpeedLimit_m_s(std::optional<double> free_m) const {
  if (!free_m) return HUGE_VAL;
  return SpeedToStopWithin_m_s(*free_m - config_.stop_gap_m, config_.deceleration_m_s2);
}

}  // namespace merlin
