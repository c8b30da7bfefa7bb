// How a URDF names the joints and links that make it a car.
#pragma once

#include <array>
#include <string>

namespace merlin {

// A name in the URDF, and the line of the file that chose it; empty if it is the rule's.
struct RoleName {
  std::string role;
  std::string name;
  std::string where;
};

struct CarMapping {
  std::array<RoleName, 4> wheel_joints;  // front left, front right, rear left, rear right
  std::array<RoleName, 2> steer_joints;  // left, right
  RoleName depth_camera, color_camera, compass;
};

// The rule that needs no mapping: wheel_front_left_joint, steer_front_left_joint, depth_camera_optical_frame, ...
CarMapping NamingRule();

}  // namespace merlin
