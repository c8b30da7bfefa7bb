#include "sim/actors/timed_path.h"

#include <algorithm>
#include <cmath>

namespace merlin::sim {

TimedPath::TimedPath(const std::vector<std::vector<double>>& points) : faces_ahead_(points[0].size() == 3) {
  for (const std::vector<double>& p : points)
    points_.push_back({p[0], {p[1], p[2], p.size() > 4 ? p[4] : 0.0}, p.size() > 3 ? p[3] : 0.0});
  if (!faces_ahead_) return;
  // A leg of zero length takes the direction of the leg before it, or of the first leg that has one.
  bool known = false;
  double yaw_rad = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (i + 1 < points_.size()) {
      const Eigen::Vector3d leg_m = points_[i + 1].position_m - points_[i].position_m;
      if (leg_m.x() != 0.0 || leg_m.y() != 0.0) {
        yaw_rad = std::atan2(leg_m.y(), leg_m.x());
        for (std::size_t before = 0; before < i && !known; ++before) points_[before].yaw_rad = yaw_rad;
        known = true;
      }
    }
    points_[i].yaw_rad = yaw_rad;
  }
}

BodyMotion TimedPath::At(double t_s) const {
  const auto after = std::ranges::upper_bound(points_, t_s, {}, &Point::t_s);
  const Point& from = after == points_.begin() ? points_.front() : *std::prev(after);
  double yaw_rad = from.yaw_rad;
  BodyMotion motion;
  motion.T_world_body.translation() = from.position_m;
  if (after != points_.begin() && after != points_.end()) {
    const double leg_s = after->t_s - from.t_s, into_s = t_s - from.t_s;
    motion.velocity_m_s = (after->position_m - from.position_m) / leg_s;
    motion.T_world_body.translation() += into_s * motion.velocity_m_s;
    if (!faces_ahead_) {
      motion.angular_velocity_rad_s.z() = (after->yaw_rad - from.yaw_rad) / leg_s;
      yaw_rad += into_s * motion.angular_velocity_rad_s.z();
    }
  }
  motion.T_world_body.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return motion;
}

std::vector<Eigen::Vector3d> TimedPath::positions_m() const {
  std::vector<Eigen::Vector3d> positions;
  for (const Point& point : points_) positions.push_back(point.position_m);
  return positions;
}

}  // namespace merlin::sim
