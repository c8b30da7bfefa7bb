// What perception hands on: trusted points, motion and heading at one instant.
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
  Eigen::Vector3f position{0, 0, 0};  // in the frame its container's name says
  float sigma_m = 0.0f;               // one standard deviation along the ray
  std::array<std::uint8_t, 3> bgr{0, 0, 0};
  bool has_color = false;
};

struct Observation {
  Time stamp{0};  // of the depth frame
  std::vector<Point> points_base;
  Eigen::Vector3f camera_base{0, 0, 0};  // where the rays begin
  double view_yaw_rad = 0.0;             // where the camera looks, from straight ahead, positive: to the left
  // The pixels without a point: ends of rays too dark to measure, before which nothing but the darkest stands; unit
  // directions of saturated ones (something close, range unknown), and of all others.
  std::vector<Eigen::Vector3f> free_base, saturated_base, unknown_base;
  std::array<int, static_cast<std::size_t>(Rejection::kCount)> rejections{};
  Pose T_odom_base = Pose::Identity();  // wheel odometry since the start
  double yaw_rad = 0.0;                 // compass and wheels together, from the world's x axis
  double yaw_sigma_rad = 0.0;           // infinite: no compass reading yet
};

}  // namespace merlin
