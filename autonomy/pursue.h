// Pure pursuit: the steering angle that brings the car back to a path, forwards or backwards.
//
// The car drives on the circle that is tangent to its own axis and passes through the first point of the path that lies a
// look-ahead distance away. With that point at (x, y) in the base frame, the curvature is 2 y / (x^2 + y^2), whether the
// point lies ahead or behind.
// Source: R. C. Coulter, "Implementation of the Pure Pursuit Path Tracking Algorithm", CMU-RI-TR-92-01, 1992.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "autonomy/intent.h"
#include "robot/types/car.h"
#include "robot/types/se3.h"

namespace merlin {

// What the car will really sweep: first the arc of pure pursuit up to the path, then the path.
struct Pursuit {
  double steering_rad = 0.0;               // of the wheels, within the limits of the car
  std::vector<Eigen::Vector2d> path_base;  // positions of the base's origin, from the present one on, in driving order
};

// The rest of a path: from the point nearest to the car to the end, in the base frame. path_map must not be empty.
std::vector<Eigen::Vector2d> RestOfPath(std::span<const Eigen::Vector2d> path_map, const Pose& T_map_base);

// path_base: the rest of the path, not empty. look_ahead_m: longer is smoother, shorter follows the path more closely.
Pursuit Pursue(const CarDescription& car, std::span<const Eigen::Vector2d> path_base, Direction direction,
               double look_ahead_m);

// How far it is to the end of the rest of a path. Not positive: the car has reached it.
double Length_m(std::span<const Eigen::Vector2d> path_base, Direction direction);

}  // namespace merlin
