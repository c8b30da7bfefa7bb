#include "autonomy/pursue.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/limits.h"
#include "robot/kinematics/motion.h"

namespace merlin {
namespace {

// A point nearer than 0.2 m would ask for a circle that no car can drive.
constexpr double kNearest_m2 = 0.04;

double Sign(Direction direction) { return direction == Direction::kForwards ? 1.0 : -1.0; }

}  // namespace

std::vector<Eigen::Vector2d> RestOfPath(std::span<const Eigen::Vector2d> path_map, const Pose& T_map_base) {
  const Eigen::Vector2d here = T_map_base.translation().head<2>();
  const auto nearer = [&here](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a - here).squaredNorm() < (b - here).squaredNorm();
  };
  const Pose T_base_map = T_map_base.inverse();
  std::vector<Eigen::Vector2d> rest_base;
  for (auto p = std::ranges::min_element(path_map, nearer); p != path_map.end(); ++p)
    rest_base.push_back((T_base_map * Eigen::Vector3d(p->x(), p->y(), 0.0)).head<2>());
  return rest_base;
}

Pursuit Pursue(const CarDescription& car, std::span<const Eigen::Vector2d> path_base, Direction direction,
               double look_ahead_m) {
  const double sign = Sign(direction);
  auto target = std::ranges::find_if(
      path_base, [=](const Eigen::Vector2d& p) { return sign * p.x() > 0.0 && p.norm() >= look_ahead_m; });
  if (target == path_base.end()) target = std::prev(path_base.end());
  const double curvature_1_m = 2.0 * target->y() / std::max(target->squaredNorm(), kNearest_m2);
  Pursuit pursuit;
  pursuit.steering_rad = ClampSteering_rad(car, WheelsAngleForCurvature_rad(car, curvature_1_m));
  pursuit.path_base = ArcAhead(car, pursuit.steering_rad, sign * target->norm());
  pursuit.path_base.insert(pursuit.path_base.end(), target, path_base.end());
  return pursuit;
}

double Length_m(std::span<const Eigen::Vector2d> path_base, Direction direction) {
  double length_m = Sign(direction) * path_base.front().x();
  for (std::size_t i = 0; i + 1 < path_base.size(); ++i) length_m += (path_base[i + 1] - path_base[i]).norm();
  return length_m;
}

}  // namespace merlin
