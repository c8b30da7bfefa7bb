#include "robot/description/car_mapping.h"

#include <gtest/gtest.h>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "tests/robot/description/car_text.h"

namespace merlin {
namespace {

using namespace car_text;

// The message about the rover's description with these two files; empty if it is accepted.
std::string RoverError(const std::string& urdf, const std::string& mapping) {
  const ForeignCar car;
  WriteRover(car);
  car.Write("car.urdf", urdf);
  car.Write("car.mapping.yaml", mapping);
  try {
    ReadCar(car.urdf());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void ExpectMapping(const std::string& from, const std::string& to, const std::vector<std::string>& says) {
  const std::string mapping = Replaced(kRoverMapping, from, to), text = RoverError(RoverUrdf(), mapping);
  for (const std::string& part : says)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' not in: " << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

void ExpectUrdf(const std::string& from, const std::string& to, const std::vector<std::string>& says) {
  const std::string text = RoverError(Replaced(RoverUrdf(), from, to), kRoverMapping);
  for (const std::string& part : says)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' not in: " << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

Eigen::Matrix3d Optical() {
  Eigen::Matrix3d rotation;
  rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return rotation;
}

TEST(CarMapping, ReadsARoverThatNamesEverythingOtherwise) {
  const ForeignCar files;
  WriteRover(files);
  const CarDescription car = ReadCar(files.urdf());
  EXPECT_EQ(car.links[0].name, "base_link");  // the root is elsewhere
  EXPECT_EQ(car.links[1].name, "chassis");
  EXPECT_LT((car.links[1].T_parent_link.translation() - Eigen::Vector3d(0.2, 0.0, 0.15)).norm(), 1e-6);
  EXPECT_NEAR(car.wheelbase_m, 0.5, 1e-6);
  EXPECT_NEAR(car.track_m, 0.4, 1e-6);
  EXPECT_NEAR(car.steering_track_m, 0.34, 1e-6);
  EXPECT_NEAR(car.wheel_radius_m, 0.1, 1e-6);  // from the meshes, with URDF's scale
  EXPECT_NEAR(car.wheels[2].width_m, 0.06, 1e-6);
  EXPECT_EQ(car.links[car.wheels[1].link].name, "wheel_fr");
  EXPECT_EQ(car.links[car.knuckles[0]].name, "knuckle_l");
  for (const CarWheel& wheel : car.wheels)
    EXPECT_LT((car.links[wheel.link].axis - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  // The inner wheel at 0.5 rad: cot(middle) = cot(inner) + track / (2 wheelbase).
  EXPECT_NEAR(1.0 / std::tan(car.steering_max_rad), 1.0 / std::tan(0.5) + 0.34 / (2.0 * 0.5), 1e-6);
  EXPECT_EQ(car.drivetrain.gear, 12.0);
  EXPECT_EQ(car.drivetrain.encoder_counts_per_motor_turn, 256);
  const Eigen::Matrix3d tof = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Vector3d tof_base(0.52, 0.01, 0.35);
  EXPECT_LT((car.T_base_depth.translation() - tof_base).norm(), 1e-6);
  EXPECT_LT((car.T_base_depth.linear() - tof * Optical()).norm(), 1e-6);
  EXPECT_LT((car.T_base_color->translation() - (tof_base + tof * Eigen::Vector3d(-0.02, 0, 0.06))).norm(), 1e-6);
  EXPECT_LT((car.T_base_color->linear() - tof * Optical()).norm(), 1e-6);
  EXPECT_LT((car.T_base_compass->translation() - Eigen::Vector3d(0.2, 0, 0.25)).norm(), 1e-6);
}

TEST(CarMapping, ReadsABuggyWhoseRootLooksAlongY) {
  const ForeignCar files;
  WriteBuggy(files);
  const CarDescription car = ReadCar(files.urdf());
  EXPECT_EQ(car.links[0].name, "base_link_");  // "base_link" is taken
  EXPECT_NEAR(car.wheelbase_m, 0.26, 1e-6);
  EXPECT_NEAR(car.track_m, 0.22, 1e-6);
  EXPECT_NEAR(car.steering_track_m, 0.20, 1e-6);
  EXPECT_NEAR(car.wheel_radius_m, 0.04, 1e-6);
  const CarLink &left = car.links[car.knuckles[0]], &right = car.links[car.knuckles[1]];
  EXPECT_EQ(right.axis, Eigen::Vector3d::UnitZ());  // turned over, its limits too
  EXPECT_NEAR(right.joint_min_rad, -0.4, 1e-12);
  EXPECT_NEAR(right.joint_max_rad, 0.6, 1e-12);
  EXPECT_NEAR(left.joint_max_rad, 0.5, 1e-12);
  // To the right the right wheel is the inner one: its 0.4 rad bind before the left wheel's limits do.
  EXPECT_NEAR(1.0 / std::tan(car.steering_max_rad), 1.0 / std::tan(0.4) + 0.20 / (2.0 * 0.26), 1e-6);
  EXPECT_LT((car.T_base_depth.translation() - Eigen::Vector3d(0.28, -0.01, 0.16)).norm(), 1e-6);
  EXPECT_LT((car.T_base_depth.linear() - Optical()).norm(), 1e-6);
  EXPECT_LT((car.T_base_compass->linear() - Eigen::Matrix3d::Identity()).norm(), 1e-6);
}

TEST(CarMapping, NamesAnUnknownKeyAndItsNearest) {
  ExpectMapping(
      "compass_frame:", "compas_frame:", {"car.mapping.yaml:10: compas_frame: unknown key", "'compass_frame'"});
  const std::string both = RoverError(RoverUrdf(), Replaced(kRoverMapping, "  gear:", "  gears:"));
  EXPECT_NE(both.find("car.mapping.yaml:12: drivetrain: missing key 'gear'"), std::string::npos) << both;
  EXPECT_NE(both.find("car.mapping.yaml:12: drivetrain.gears: unknown key; did you mean 'gear'?"), std::string::npos)
      << both;
  ExpectMapping("  gear: 12", "  gear: 12\n  volts: 3", {"car.mapping.yaml:13: drivetrain.volts: unknown key"});
}

TEST(CarMapping, NamesAJointThatIsNotThereAndItsNearest) {
  ExpectMapping(": axle_fl", ": axel_fl",
                {"car.mapping.yaml:2", "'wheel_front_left_joint'", "'axel_fl'", "did you mean 'axle_fl'"});
  ExpectMapping(": imu", ": chasis", {"car.mapping.yaml:10", "link 'chasis'", "did you mean 'chassis'"});
}

TEST(CarMapping, RefusesOneJointInTwoRoles) {
  ExpectMapping(": axle_fr", ": axle_fl",
                {"car.mapping.yaml:3", "'wheel_front_right_joint'", "'axle_fl' already has another role"});
  ExpectMapping("steer_front_left_joint", "steer_front_right_joint", {"car.mapping.yaml:7", "given twice"});
  ExpectMapping("compass_frame", "depth_camera_optical_frame",
                {"car.mapping.yaml:8", "depth_camera_frame: stands beside"});
}

TEST(CarMapping, RejectsAFileThatIsNotAMapping) {
  EXPECT_NE(RoverError(RoverUrdf(), "").find("no map of keys; expected a car's mapping"), std::string::npos);
  EXPECT_NE(RoverError(RoverUrdf(), "- a\n- b\n").find("no map of keys; expected a car's mapping"), std::string::npos);
  EXPECT_NE(RoverError(RoverUrdf(), "a: [1\nb: }").find("broken YAML"), std::string::npos);
  ExpectMapping(": axle_fl", ": [axle_fl]", {"car.mapping.yaml:2: wheel_front_left_joint: expected a text"});
  ExpectMapping(": axle_fl", ": ''", {"car.mapping.yaml:2: wheel_front_left_joint: expected a name in the URDF"});
  for (const std::string number : {"0", "-1", ".nan", ".inf", "twelve", "[1]"})
    ExpectMapping("gear: 12", "gear: " + number, {"car.mapping.yaml:12: drivetrain.gear: expected a positive number"});
  ExpectMapping("turn: 256", "turn: 2.5", {"a whole number"});
}

TEST(CarMapping, NamesWhatCannotPlayItsRole) {
  const std::string axle = "<joint name=\"axle_rl\" type=\"continuous\">";
  ExpectUrdf(axle,
             "<joint name=\"axle_rl\" type=\"prismatic\"><limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/>",
             {"car.urdf:", "'axle_rl' must turn", "continuous"});
  ExpectUrdf(axle, "<joint name=\"axle_rl\" type=\"floating\">", {"car.urdf:", "'axle_rl'", "type"});
  ExpectUrdf("<joint name=\"kingpin_l\" type=\"revolute\">", "<joint name=\"kingpin_l\" type=\"continuous\">",
             {"'kingpin_l' must steer", "revolute, with limits"});
  ExpectUrdf("<parent link=\"knuckle_l\"/>", "<parent link=\"knuckle_r\"/>", {"'axle_fl' does not hang"});
  ExpectUrdf("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 1 0\"/>", {"'kingpin_r': axis", "upright"});
  ExpectUrdf("<axis xyz=\"0 -1 0\"/>", "<axis xyz=\"1 0 0\"/>", {"'wheel_fr'"});
  ExpectUrdf("xyz=\"0.3 -0.17 -0.02\"", "xyz=\"0.25 -0.17 -0.02\"", {"axle"});
}

TEST(CarMapping, NamesASensorLinkThatIsMissing) {
  const std::string mapping = Replaced(
      Replaced(Replaced(kRoverMapping, "depth_camera_frame: tof\n", ""), "color_camera_optical_frame: eye\n", ""),
      "compass_frame: imu\n", "");
  const std::string text = RoverError(RoverUrdf(), mapping);
  EXPECT_NE(
      text.find("car.urdf: the car needs a link 'depth_camera_optical_frame', or another that car.mapping.yaml names"),
      std::string::npos)
      << text;
}

TEST(CarMapping, NamesAMissingDrivetrain) {
  const std::string mapping = kRoverMapping;
  const std::string text = RoverError(RoverUrdf(), mapping.substr(0, mapping.find("drivetrain:")));
  EXPECT_NE(text.find("<drivetrain .../> under <robot>, or a map 'drivetrain' in car.mapping.yaml"), std::string::npos)
      << text;
}

// Without shapes on the wheels the mapping must say how large they are.
TEST(CarMapping, StatesTheTyresWhereNoShapeDoes) {
  std::string urdf = RoverUrdf();
  for (std::size_t at; (at = urdf.find("wheel.obj")) != std::string::npos;) {
    const std::size_t from = urdf.rfind("<mesh", at), to = urdf.find("/>", at) + 2;
    urdf.replace(from, to - from, "<box size=\"0.2 0.06 0.2\"/>");
  }
  const std::string text = RoverError(urdf, kRoverMapping);
  EXPECT_NE(text.find("how large the tyre is"), std::string::npos) << text;
  EXPECT_NE(text.find("wheel_radius_m and wheel_width_m in car.mapping.yaml"), std::string::npos) << text;
  EXPECT_EQ(RoverError(urdf, std::string(kRoverMapping) + "wheel_radius_m: 0.1\nwheel_width_m: 0.06\n"), "");
}

}  // namespace
}  // namespace merlin
