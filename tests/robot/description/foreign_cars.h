// Two cars as others might describe them, with other names, axes, proportions and mesh formats.
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "tests/robot/description/mesh_text.h"

namespace merlin {

// A temporary folder, removed with the object.
class ForeignCar {
 public:
  ForeignCar() {
    std::string pattern = (std::filesystem::temp_directory_path() / "merlin_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~ForeignCar() { std::filesystem::remove_all(folder_); }
  ForeignCar(const ForeignCar&) = delete;
  ForeignCar& operator=(const ForeignCar&) = delete;
  void Write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  std::filesystem::path urdf() const { return folder_ / "car.urdf"; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

// A prism of 48 sides about the y axis.
inline std::string WheelObj(double radius_m, double width_m) {
  constexpr int kSides = 48;
  std::string text;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    for (const double y : {-0.5 * width_m, 0.5 * width_m})
      text += fmt::format("v {} {} {}\n", radius_m * std::sin(angle), y, radius_m * std::cos(angle));
  }
  text += fmt::format("v 0 {} 0\nv 0 {} 0\n", -0.5 * width_m, 0.5 * width_m);
  for (int i = 0; i < kSides; ++i) {
    const int a = 2 * i + 1, b = 2 * ((i + 1) % kSides) + 1;
    text += fmt::format("f {} {} {} {}\nf {} {} {}\nf {} {} {}\n", a, b, b + 1, a + 1, 2 * kSides + 1, b, a,
                        2 * kSides + 2, a + 1, b + 1);
  }
  return text;
}

inline std::string Inertial(double mass_kg, double radius_m) {
  const double moment = 0.4 * mass_kg * radius_m * radius_m;
  return fmt::format(
      "<inertial><mass value=\"{}\"/><inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"0\" ixz=\"0\" "
      "iyz=\"0\"/></inertial>",
      mass_kg, moment, moment, moment);
}

inline std::string Joint(const std::string& name, const std::string& type, const std::string& parent,
                         const std::string& child, const std::string& rest) {
  return fmt::format("<joint name=\"{}\" type=\"{}\"><parent link=\"{}\"/><child link=\"{}\"/>{}</joint>\n", name, type,
                     parent, child, rest);
}

constexpr char kRoverMapping[] = R"(# a rover's names
wheel_front_left_joint: axle_fl
wheel_front_right_joint: axle_fr
wheel_rear_left_joint: axle_rl
wheel_rear_right_joint: axle_rr
steer_front_left_joint: kingpin_l
steer_front_right_joint: kingpin_r
depth_camera_frame: tof
color_camera_optical_frame: eye
compass_frame: imu
drivetrain:
  gear: 12
  encoder_counts_per_motor_turn: 256
  motor_constant_v_s: 0.05
  resistance_ohm: 0.5
  rotor_inertia_kg_m2: 4e-5
  voltage_max_v: 24
  speed_max_m_s: 2
  acceleration_max_m_s2: 1.5
  steering_slew_rad_s: 3
  tyre_friction: 0.9
)";

// Root "chassis" in the body's middle, 0.2 m before the rear axle and 0.15 m up; wheelbase 0.5, track 0.4, radius 0.1.
// Right before left, the right wheels' axes point to the right, the kingpins stand 3 cm inside the wheels, the left
// knuckle mimics the right one; wheels are OBJ meshes, the body is COLLADA in centimetres with y up.
inline std::string RoverUrdf() {
  std::string text = "<robot name=\"rover\">\n<link name=\"chassis\">" + Inertial(8.0, 0.15) +
                     "<visual><geometry><mesh filename=\"package://rover/body.dae\"/></geometry></visual>"
                     "<collision><geometry><box size=\"0.6 0.25 0.12\"/></geometry></collision></link>\n";
  const std::string tyre = "<geometry><mesh filename=\"wheel.obj\" scale=\"0.001 0.001 0.001\"/></geometry>";
  const std::string limit = "<limit lower=\"-0.5\" upper=\"0.5\" effort=\"9\" velocity=\"3\"/>";
  for (const std::string side : {"r", "l"}) {
    const double y = side == "r" ? -1.0 : 1.0;
    const std::string axis = fmt::format("<axis xyz=\"0 {} 0\"/>", y);
    for (const std::string end : {"f", "r"})
      text += "<link name=\"wheel_" + end + side + "\">" + Inertial(0.6, 0.1) + "<visual>" + tyre +
              "</visual><collision>" + tyre + "</collision></link>\n";
    text += "<link name=\"knuckle_" + side + "\">" + Inertial(0.1, 0.03) + "</link>\n";
    text += Joint("kingpin_" + side, "revolute", "chassis", "knuckle_" + side,
                  fmt::format("<origin xyz=\"0.3 {} -0.02\"/><axis xyz=\"0 0 1\"/>", 0.17 * y) + limit +
                      (side == "l" ? "<mimic joint=\"kingpin_r\"/>" : ""));
    text += Joint("axle_f" + side, "continuous", "knuckle_" + side, "wheel_f" + side,
                  fmt::format("<origin xyz=\"0 {} -0.03\"/>", 0.03 * y) + axis);
    text += Joint("axle_r" + side, "continuous", "chassis", "wheel_r" + side,
                  fmt::format("<origin xyz=\"-0.2 {} -0.05\"/>", 0.2 * y) + axis + "<mimic joint=\"axle_fr\"/>");
  }
  text += "<link name=\"tof\"/><link name=\"eye\"/><link name=\"imu\"/>\n";
  text += Joint("tof_joint", "fixed", "chassis", "tof", "<origin xyz=\"0.32 0.01 0.2\" rpy=\"0 0.1 0\"/>");
  text += Joint("eye_joint", "fixed", "tof", "eye",
                "<origin xyz=\"-0.02 0 0.06\" rpy=\"-1.5707963267948966 0 -1.5707963267948966\"/>");
  text += Joint("imu_joint", "fixed", "chassis", "imu", "<origin xyz=\"0 0 0.1\"/>");
  return text + "</robot>\n";
}

inline void WriteRover(const ForeignCar& car) {
  car.Write("car.urdf", RoverUrdf());
  car.Write("car.mapping.yaml", kRoverMapping);
  car.Write("wheel.obj", WheelObj(100.0, 60.0));
  car.Write("body.dae", mesh_text::Dae({.box = {60, 12, 25}, .up = "Y_UP", .unit_m = 0.01}));
}

constexpr char kBuggyMapping[] = R"(wheel_front_left_joint: left_wheel
wheel_front_right_joint: right_wheel
steer_front_left_joint: left_steering
steer_front_right_joint: right_steering
drivetrain: {gear: 8, encoder_counts_per_motor_turn: 100, motor_constant_v_s: 0.01, resistance_ohm: 0.3,
  rotor_inertia_kg_m2: 3e-6, voltage_max_v: 7.4, speed_max_m_s: 1.5, acceleration_max_m_s2: 2, steering_slew_rad_s: 4,
  tyre_friction: 0.8}
)";

// Root on the ground below the front axle, its y ahead; wheelbase 0.26, radius 0.04, track 0.20 in front and 0.24
// behind. Its rear and sensors go by the rule. The right knuckle's axis points down and has other limits. Front tyres
// are cylinders, rear ones balls; a spring of the rear left wheel, a spinning lidar and a screen on a hinge have no
// role.
inline std::string BuggyUrdf() {
  const std::string cylinder =
      "<collision><origin rpy=\"0 1.5707963267948966 0\"/><geometry><cylinder radius=\"0.04\" "
      "length=\"0.03\"/></geometry></collision>";
  const std::string ball = "<collision><geometry><sphere radius=\"0.04\"/></geometry></collision>";
  std::string text = "<robot name=\"buggy\">\n<link name=\"base_footprint\"/><link name=\"base_link\">" +
                     Inertial(1.5, 0.08) +
                     "<visual><geometry><mesh filename=\"body.glb\"/></geometry></visual><collision><geometry>"
                     "<mesh filename=\"body.stl\"/></geometry></collision></link>\n";
  for (const std::string name : {"hub_l", "hub_r", "rear_l", "rear_r"})
    text += "<link name=\"" + name + "\">" + Inertial(0.1, 0.04) + (name.starts_with("hub") ? cylinder : ball) +
            "</link>\n";
  for (const std::string name : {"arm_l", "arm_r", "spring", "lidar", "screen"})
    text += "<link name=\"" + name + "\">" + Inertial(0.02, 0.02) + "</link>\n";
  text +=
      "<link name=\"depth_camera_optical_frame\"/><link name=\"color_camera_optical_frame\"/><link "
      "name=\"compass_frame\"/>\n";
  text += Joint("body", "fixed", "base_footprint", "base_link", "<origin xyz=\"0 -0.13 0.06\"/>");
  text += Joint("right_steering", "revolute", "base_link", "arm_r",
                "<origin xyz=\"0.1 0.13 -0.02\"/><axis xyz=\"0 0 -1\"/>"
                "<limit lower=\"-0.6\" upper=\"0.4\" effort=\"9\" velocity=\"3\"/>");
  text += Joint("left_steering", "revolute", "base_link", "arm_l",
                "<origin xyz=\"-0.1 0.13 -0.02\"/><axis xyz=\"0 0 1\"/>"
                "<limit lower=\"-0.5\" upper=\"0.5\" effort=\"9\" velocity=\"3\"/><mimic joint=\"right_steering\" "
                "multiplier=\"-1\"/>");
  text += Joint("left_wheel", "continuous", "arm_l", "hub_l", "<axis xyz=\"-1 0 0\"/>");
  text += Joint("right_wheel", "continuous", "arm_r", "hub_r", "<axis xyz=\"1 0 0\"/>");
  text += Joint("spring_joint", "prismatic", "base_link", "spring",
                "<origin xyz=\"-0.12 -0.13 0\"/><axis xyz=\"0 0 1\"/>"
                "<limit lower=\"-0.01\" upper=\"0.01\" effort=\"9\" velocity=\"3\"/>");
  text += Joint("wheel_rear_left_joint", "continuous", "spring", "rear_l",
                "<origin xyz=\"0 0 -0.02\"/><axis xyz=\"-1 0 0\"/>");
  text += Joint("wheel_rear_right_joint", "continuous", "base_link", "rear_r",
                "<origin xyz=\"0.12 -0.13 -0.02\"/><axis xyz=\"-1 0 0\"/>");
  text += Joint("lidar_joint", "continuous", "base_link", "lidar", "<origin xyz=\"0 0 0.05\"/><axis xyz=\"0 0 1\"/>");
  text += Joint("screen_joint", "revolute", "base_link", "screen",
                "<origin xyz=\"0 -0.1 0.05\"/><axis xyz=\"1 0 0\"/>"
                "<limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/>");
  text += Joint("d", "fixed", "base_link", "depth_camera_optical_frame",
                "<origin xyz=\"0.01 0.15 0.1\" rpy=\"-1.5707963267948966 0 0\"/>");
  text += Joint("c", "fixed", "base_link", "color_camera_optical_frame",
                "<origin xyz=\"0 0.12 0.15\" rpy=\"-1.5707963267948966 0 0\"/>");
  text +=
      Joint("i", "fixed", "base_link", "compass_frame", "<origin xyz=\"0 0 0.12\" rpy=\"0 0 1.5707963267948966\"/>");
  return text + "</robot>\n";
}

inline void WriteBuggy(const ForeignCar& car) {
  car.Write("car.urdf", BuggyUrdf());
  car.Write("car.mapping.yaml", kBuggyMapping);
  car.Write("body.glb", mesh_text::Glb({.box = {0.14, 0.05, 0.3}}));
  car.Write("body.stl", mesh_text::StlBinary({0.14, 0.3, 0.05}));
}

}  // namespace merlin
