#include "autonomy/avoid.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace merlin {

Footprint FootprintOf(const CarDescription& car) {
  Footprint footprint;
  std::map<std::string, Pose> T_base_link;
  for (const CarLink& link : car.links) {
    const auto parent = T_base_link.find(link.parent);
    const Pose T = parent == T_base_link.end() ? Pose::Identity() : parent->second * link.T_parent_link;
    T_base_link[link.name] = T;
    for (const CarShape& shape : link.collision) {
      Eigen::Vector3d half = 0.5 * shape.size_m;
      if (shape.kind == CarShape::Kind::kSphere) half.setConstant(shape.size_m.x());
      if (shape.kind == CarShape::Kind::kCylinder) half = {shape.size_m.x(), shape.size_m.x(), 0.5 * shape.size_m.y()};
      const Pose T_base_shape = T * shape.T_link_shape;
      const Eigen::Vector3d reach = T_base_shape.linear().cwiseAbs() * half;
      footprint.front_m = std::max(footprint.front_m, T_base_shape.translation().x() + reach.x());
      footprint.half_width_m = std::max(footprint.half_width_m, std::abs(T_base_shape.translation().y()) + reach.y());
    }
  }
  return footprint;
}

std::optional<double> Avoid::SeenNow_m(const Observation& observation, std::span<const Eigen::Vector2d> path_base) const {
  const auto ahead = [this](const Eigen::Vector3f& d) {
    return std::abs(std::atan2(d.y(), d.x())) < config_.saturated_half_angle_rad;
  };
  if (std::ranges::count_if(observation.saturated_base, ahead) >= config_.saturated_min) return 0.0;

  std::vector<double> way_m(path_base.size(), 0.0);
  for (std::size_t i = 1; i < path_base.size(); ++i) way_m[i] = way_m[i - 1] + (path_base[i] - path_base[i - 1]).norm();
  const double half_width_m = footprint_.half_width_m + config_.margin_m;
  std::vector<double> in_the_way_m;
  for (const Point& point : observation.points_base) {
    if (point.position.z() < config_.height_min_m || point.position.z() > config_.height_max_m) continue;
    const Eigen::Vector2d p = point.position.head<2>().cast<double>();
    double best = half_width_m * half_width_m;
    std::optional<double> at_m;
    for (std::size_t i = 0; i < path_base.size(); ++i) {
      const double squared = (path_base[i] - p).squaredNorm();
      if (squared < best) best = squared, at_m = way_m[i];
    }
    if (at_m) in_the_way_m.push_back(*at_m);
  }
  if (static_cast<int>(in_the_way_m.size()) < config_.points_min) return std::nullopt;
  const auto nth = in_the_way_m.begin() + (config_.points_min - 1);
  std::nth_element(in_the_way_m.begin(), nth, in_the_way_m.end());
  return std::max(0.0, *nth - footprint_.front_m);
}

std::optional<double> Avoid::FreeWay_m(const Observation& observation, std::span<const Eigen::Vector2d> path_base) {
  std::optional<double> free_way_m = SeenNow_m(observation, path_base);
  if (last_ && Seconds(observation.stamp - last_->stamp) <= config_.hold_s) {
    const double driven_m = (last_->T_odom_base.inverse() * observation.T_odom_base).translation().norm();
    const double remembered_m = std::max(0.0, last_->free_way_m - driven_m);
    if (!free_way_m) return remembered_m;
  }
  if (free_way_m) last_ = Sight{observation.stamp, observation.T_odom_base, *free_way_m};
  return free_way_m;
}

double Avoid::SpeedLimit_m_s(std::optional<double> free_way_m) const {
  if (!free_way_m) return HUGE_VAL;
  return std::sqrt(2.0 * config_.deceleration_m_s2 * std::max(0.0, *free_way_m - config_.stop_gap_m));
}

}  // namespace merlin
