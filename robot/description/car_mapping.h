// Which joints and links of a URDF play which part of a car. A URDF with names of its own needs a small YAML file
// beside it, <its stem>.mapping.yaml:
//
//   wheel_front_left_joint: axle_fl         # the role's name: the joint's name there; the four driven wheels ...
//   steer_front_left_joint: kingpin_l       # ... and what steers the two front ones
//   depth_camera_optical_frame: tof_lens    # a link with z ahead, x right, y down; or
//   color_camera_frame: webcam              # ... without "optical": x ahead, y left, z up
//   compass_frame: imu_link                 # optional as the colour camera: a car may be without
//   pan_joint: neck                         # optional: turns both cameras; revolute, upright
//   steering_limit_rad: 0.5                 # optional: how far a knuckle turns to either side; continuous ones need it
//   wheel_radius_m: 0.1                     # optional, and wheel_width_m: where the wheels' shapes do not say it
//   drivetrain: {gear: 10, ...}             # as the element <drivetrain> of models/merlin/merlin.urdf
//
// A role that the file leaves out has its default name, which is the key itself (wheel_front_left_joint, ...). If the
// file leaves out the colour camera or the compass, and the URDF has no link of the default name, then the car has
// none. A URDF with default names and a <drivetrain> needs no file.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "robot/types/car.h"

namespace merlin {

// A name in the URDF, and the line of the mapping file that gives it; empty for the default name.
struct RoleName {
  std::string role;
  std::string name;
  std::string where;
};

struct CarMapping {
  bool has_file = false;
  std::array<RoleName, 4> wheel_joints{{{"wheel_front_left_joint", "wheel_front_left_joint", ""},
                                        {"wheel_front_right_joint", "wheel_front_right_joint", ""},
                                        {"wheel_rear_left_joint", "wheel_rear_left_joint", ""},
                                        {"wheel_rear_right_joint", "wheel_rear_right_joint", ""}}};
  std::array<RoleName, 2> steer_joints{{{"steer_front_left_joint", "steer_front_left_joint", ""},
                                        {"steer_front_right_joint", "steer_front_right_joint", ""}}};
  // Cameras: role "..._optical_frame", or "..._frame" for a link with the body's axes.
  RoleName depth_camera{"depth_camera_optical_frame", "depth_camera_optical_frame", ""};
  RoleName color_camera{"color_camera_optical_frame", "color_camera_optical_frame", ""};
  RoleName compass{"compass_frame", "compass_frame", ""};
  RoleName pan_joint{"pan_joint", "pan_joint", ""};  // a car without it has fixed cameras
  std::optional<double> steering_limit_rad, wheel_radius_m, wheel_width_m;
  std::optional<Drivetrain> drivetrain;
};

std::filesystem::path MappingFile(const std::filesystem::path& urdf);

// Reads the mapping beside this URDF; all defaults if there is none. Throws InputError with file and line of each
// fault: not YAML, a key that is unknown (names the nearest) or given twice, a value that is not a name or not a
// positive number.
CarMapping ReadMapping(const std::filesystem::path& urdf);

}  // namespace merlin
