// The result of perception for one depth frame: the points that can be trusted, wheel odometry and heading, all at the
// frame's stamp.
//
//   frame  origin and axes
//   base   the car at the stamp: on the ground below the rear axle's middle, x forward, y left, z up
//   odom   where wheel odometry began; drifts
//   world  the twin's and the compass's: yaw counts counter-clockwise from its x axis
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "perception/filter/depth_filter.h"
#include "robot/types/se3.h"
#include "robot/types/time.h"

namespace merlin {

struct Point {
  Eigen::Vector3f position{0, 0, 0};  // in the frame that its container's name ends with
  float sigma_m = 0.0f;               // one standard deviation along the ray
  std::array<std::uint8_t, 3> bgr{0, 0, 0};
  bool has_color = false;
};

struct Observation {
  Time stamp{0};  // of the depth frame
  std::vector<Point> points_base;
  Eigen::Vector3f camera_base{0, 0, 0};  // where the rays begin
  double view_yaw_rad = 0.0;             // direction of the camera, from straight ahead; positive: to the left
  bool pans = false;                     // a pan unit turns the camera
  double half_view_rad = 0.0, half_view_up_rad = 0.0;  // the view reaches so far to either side, and up and down
  // Pixels without a point. free_base: ends of rays that were too dark to measure; up to there is free space, or
  // something very dark. saturated_base: unit directions in which something is close, at an unknown range.
  // unknown_base: unit directions of all others.
  std::vector<Eigen::Vector3f> free_base, saturated_base, unknown_base;
  double pixel_sr = 0.0;  // solid angle of one pixel; 0: not known
  // False: a shorter exposure can still measure what saturates in this one.
  bool shortest_exposure = true;
  std::array<int, static_cast<std::size_t>(Rejection::kCount)> rejections{};
  Pose T_odom_base = Pose::Identity();  // wheel odometry since the start
  double yaw_rad = 0.0;                 // heading by compass and wheels, in the world
  double yaw_sigma_rad = 0.0;           // one standard deviation of it; infinite before the first compass reading
};

}  // namespace merlin
