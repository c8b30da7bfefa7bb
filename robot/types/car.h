// The car as plain data, as its URDF describes it. The twin builds a body from it; the stack uses its frames.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "robot/types/se3.h"

namespace merlin {

// Triangles of one colour, out of a mesh file; in metres, z up.
struct CarMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> triangles;    // three indices into vertices each, counter-clockwise seen from outside
  std::optional<std::array<float, 4>> rgba;  // none: the file gives no colour
};

struct CarShape {
  enum class Kind { kBox, kCylinder, kSphere, kMesh };
  Kind kind = Kind::kBox;
  Eigen::Vector3d size_m{
      0, 0, 0};  // box: full edges; cylinder: radius, length (along z), 0; sphere: radius, 0, 0; mesh: scale
  std::filesystem::path mesh_file;  // absolute; what it holds:
  std::shared_ptr<const CarMesh> mesh;
  Pose T_link_shape = Pose::Identity();
  std::string material;  // a name in materials.yaml; may be empty
  std::array<float, 4> rgba{0.5f, 0.5f, 0.5f, 1.0f};
};

struct CarLink {
  enum class Joint { kFixed, kRevolute, kContinuous, kPrismatic };
  std::string name;
  std::string parent;  // empty for the root, base_link
  std::string joint_name;
  Joint joint = Joint::kFixed;
  Pose T_parent_link = Pose::Identity();            // at joint angle 0
  Eigen::Vector3d axis{1, 0, 0};                    // of the joint, in the link's frame
  double joint_min_rad = 0.0, joint_max_rad = 0.0;  // of a revolute joint
  double joint_speed_max_rad_s = 0.0;               // of a revolute joint
  double mass_kg = 0.0;                             // 0: a frame only
  Pose T_link_inertial = Pose::Identity();
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  // about the inertial frame
  std::vector<CarShape> visual, collision;
};

// Motor, gear and encoder: the element <drivetrain> of the URDF, or the map of that name in the mapping.
struct Drivetrain {
  double gear = 0.0;  // motor turns for one turn of a wheel
  int encoder_counts_per_motor_turn = 0;
  double motor_constant_v_s = 0.0;  // K: V per rad/s and N m per A
  double resistance_ohm = 0.0;
  double rotor_inertia_kg_m2 = 0.0;
  double voltage_max_v = 0.0;
  double speed_max_m_s = 0.0;
  double acceleration_max_m_s2 = 0.0;
  double steering_slew_rad_s = 0.0;
  double tyre_friction = 0.0;
};

// A driven wheel. Its joint's axis points to the left: positive turns roll the car forwards.
struct CarWheel {
  std::size_t link = 0;                 // its index in links
  Pose T_link_tyre = Pose::Identity();  // the tyre's middle, z along the axle
  double width_m = 0.0;                 // of the tyre
};

// The pan unit, which turns both cameras about the vertical.
struct CarPan {
  std::size_t link = 0;                // its index in links; the cameras hang below it
  Pose T_base_pan = Pose::Identity();  // at angle 0, z up along the axis
  double slew_rad_s = 0.0;
  bool moves = false;  // false: it is held straight ahead, as on MERLIN

  // The pose of a camera, given the one at angle 0 (ahead); positive to the left.
  Pose Turned(const Pose& T_base_camera, double angle_rad) const {
    return T_base_pan * FromXyYaw(0.0, 0.0, angle_rad) * T_base_pan.inverse() * T_base_camera;
  }
};

// The parts are known by their roles: no user of this struct needs their names in the URDF. Joints without a role do
// not move.
struct CarDescription {
  std::string name;
  std::filesystem::path file;         // its URDF; empty: made in code
  std::vector<std::string> warnings;  // for the user, one sentence each
  std::vector<CarLink> links;  // parents before children; [0] is the base: on the ground below the rear axle's middle
  std::array<CarWheel, 4> wheels{};  // front left, front right, rear left, rear right
  std::array<std::size_t, 2>
      knuckles{};             // indices in links: what steers the front wheels, left and right; positive to the left
  std::optional<CarPan> pan;  // none: the cameras are fixed
  // Derived from the links, so that they cannot disagree with them:
  double wheelbase_m = 0.0;       // mean of left and right; the links keep the poses of the URDF
  double track_m = 0.0;           // between the wheels' middles, mean of front and rear
  double steering_track_m = 0.0;  // between the two steering axes, which may lie beside the wheels' middles
  double wheel_radius_m = 0.0;
  double steering_max_rad = 0.0;  // of the virtual wheel midway between the front ones, as the knuckles' limits allow
  double steering_offset_rad = 0.0;  // of the wheels from what the servo reports; only a calibration knows it
  Drivetrain drivetrain;
  Pose T_base_depth = Pose::Identity();  // optical frames, looking ahead
  std::optional<Pose> T_base_color;      // none: the car has no colour camera
  std::optional<Pose> T_base_compass;    // none: it has no compass

  // The axis of a turntable under the car. It goes through the origin of the base frame, so that turning does not
  // change the car's true position. (If the origin moved on a small circle, the judge would mistake noise of the path
  // for a rotation of the map.)
  Pose T_base_turntable() const { return Pose::Identity(); }

  double MetresPerCount() const {  // of the mean path of the four wheels
    return 2.0 * std::numbers::pi * wheel_radius_m / (drivetrain.gear * drivetrain.encoder_counts_per_motor_turn);
  }
};

}  // namespace merlin
