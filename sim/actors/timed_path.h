// Where an actor is at each instant, and how fast.
#pragma once

#include <vector>

#include "sim/world/motion.h"

namespace merlin::sim {

// Straight and even between points, at rest before the first and after the last.
class TimedPath {
 public:
  // Points as ActorConfig::path has them, which RefuseFaults has passed.
  explicit TimedPath(const std::vector<std::vector<double>>& points);

  // Of the actor's frame, world frame. At a point: the velocity with which it goes on.
  BodyMotion At(double t_s) const;
  double begin_s() const { return points_.front().t_s; }
  // [point], world frame.
  std::vector<Eigen::Vector3d> positions_m() const;

 private:
  struct Point {
    double t_s;
    Eigen::Vector3d position_m;
    double yaw_rad;
  };
  std::vector<Point> points_;
  bool faces_ahead_;  // yaw is that of the leg from the point on, not in between
};

}  // namespace merlin::sim
