// The path of an actor: pose and velocity at each time.
#pragma once

#include <vector>

#include "sim/world/motion.h"

namespace merlin::sim {

// Straight at constant speed between points, at rest before the first and after the last.
class TimedPath {
 public:
  // points: ActorConfig::path, checked by RefuseFaults.
  explicit TimedPath(const std::vector<std::vector<double>>& points);

  // Motion of the actor's frame in the world. At a point of the path the velocity is that of the next leg.
  BodyMotion At(double t_s) const;
  double begin_s() const { return points_.front().t_s; }
  // The points of the path in the world frame.
  std::vector<Eigen::Vector3d> positions_m() const;

 private:
  struct Point {
    double t_s;
    Eigen::Vector3d position_m;
    double yaw_rad;
  };
  std::vector<Point> points_;
  bool faces_ahead_;  // a point's yaw is the direction of the next leg, and is not interpolated
};

}  // namespace merlin::sim
