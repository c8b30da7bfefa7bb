#include "autonomy/seen_ahead.h"

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

constexpr double kAhead_m = 3.0;   // what is farther ahead than this is no obstacle yet, and will be seen again
constexpr double kBehind_m = 0.1;  // behind the base's origin the car has passed it
constexpr double kEdge = 0.95;     // share of the view in which a point would surely be seen again

}  // namespace

void SeenAhead::Add(const Observation& observation, double height_min_m, double height_max_m) {
  if (observation.stamp <= stamp_) return;
  if (stamp_ >= Time(0)) path_m_ += (T_odom_base_.inverse() * observation.T_odom_base).translation().norm();
  stamp_ = observation.stamp;
  T_odom_base_ = observation.T_odom_base;
  camera_base_ = observation.camera_base.cast<double>();
  view_yaw_rad_ = observation.view_yaw_rad;
  half_view_rad_ = observation.half_view_rad;
  half_view_up_rad_ = observation.half_view_up_rad;
  ForgetWhatIsSeenAgain();
  for (Point point : observation.points_base) {
    if (point.position.z() < height_min_m || point.position.z() > height_max_m) continue;
    if (point.position.x() > kAhead_m) continue;
    point.position = (T_odom_base_ * point.position.cast<double>()).cast<float>();
    points_odom_.push_back(point);
  }
}

void SeenAhead::ForgetWhatIsSeenAgain() {
  const Pose T_base_odom = T_odom_base_.inverse();
  std::erase_if(points_odom_, [&](const Point& point) {
    const Eigen::Vector3d p_base = T_base_odom * point.position.cast<double>();
    if (p_base.x() < -kBehind_m || p_base.head<2>().norm() > kAhead_m) return true;
    const Eigen::Vector3d ray = p_base - camera_base_;
    const double aside_rad = WrapPi(std::atan2(ray.y(), ray.x()) - view_yaw_rad_);
    const double up_rad = std::atan2(ray.z(), ray.head<2>().norm() * std::cos(aside_rad));
    return std::abs(aside_rad) < kEdge * half_view_rad_ && std::abs(up_rad) < kEdge * half_view_up_rad_;
  });
}

std::vector<Point> SeenAhead::PointsBase() const {
  const Pose T_base_odom = T_odom_base_.inverse();
  std::vector<Point> points = points_odom_;
  for (Point& point : points) point.position = (T_base_odom * point.position.cast<double>()).cast<float>();
  return points;
}

bool SeenAhead::Sees(const Eigen::Vector2d& point_base) const {
  const Eigen::Vector2d ray = point_base - camera_base_.head<2>();
  return std::abs(WrapPi(std::atan2(ray.y(), ray.x()) - view_yaw_rad_)) <= half_view_rad_;
}

SeenAhead::Age SeenAhead::OldestLook(const PathAcross& across) {
  for (std::size_t i = 0; i < across.size(); ++i)
    if (Sees(across[i])) looks_[i] = Look{stamp_, path_m_};
  Age oldest;
  for (const std::optional<Look>& look : looks_) {
    if (!look) return {HUGE_VAL, HUGE_VAL};
    oldest.time_s = std::max(oldest.time_s, Seconds(stamp_ - look->stamp));
    oldest.driven_m = std::max(oldest.driven_m, path_m_ - look->path_m);
  }
  return oldest;
}

}  // namespace merlin
