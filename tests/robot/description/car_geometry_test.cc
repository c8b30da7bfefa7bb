// What ReadCar derives from the links: lengths, angles, sensor frames; and the cars that it rejects because of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "tests/robot/description/description_fixture.h"

namespace merlin {
namespace {

using namespace car_text;

TEST_F(Description, MerlinHasItsGeometry) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  EXPECT_EQ(car.name, "merlin");
  EXPECT_NEAR(car.wheelbase_m, 0.33, 1e-12);
  EXPECT_NEAR(car.track_m, 0.26, 1e-12);
  EXPECT_NEAR(car.wheel_radius_m, 0.055, 1e-12);
  EXPECT_NEAR(car.steering_max_rad, 25.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_EQ(car.drivetrain.gear, 10.0);
  EXPECT_EQ(car.drivetrain.encoder_counts_per_motor_turn, 512);
  EXPECT_EQ(car.drivetrain.motor_constant_v_s, 0.03);
  EXPECT_EQ(car.drivetrain.resistance_ohm, 0.6);
  EXPECT_EQ(car.drivetrain.rotor_inertia_kg_m2, 2e-5);
  EXPECT_EQ(car.drivetrain.voltage_max_v, 12.0);
  EXPECT_EQ(car.drivetrain.speed_max_m_s, 2.0);
  EXPECT_EQ(car.drivetrain.acceleration_max_m_s2, 2.0);
  EXPECT_EQ(car.drivetrain.steering_slew_rad_s, 3.2);
  EXPECT_EQ(car.drivetrain.tyre_friction, 0.9);
  EXPECT_NEAR(car.MetresPerCount(), 2.0 * std::numbers::pi * 0.055 / 5120.0, 1e-15);
}

TEST_F(Description, MerlinWeighsSixAndAHalfKilogramsLow) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  std::map<std::string, Pose> T_base;
  double mass_kg = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const CarLink& link : car.links) {
    T_base[link.name] = link.parent.empty() ? Pose::Identity() : T_base.at(link.parent) * link.T_parent_link;
    mass_kg += link.mass_kg;
    moment += link.mass_kg * (T_base[link.name] * link.T_link_inertial).translation();
  }
  EXPECT_NEAR(mass_kg, 6.5, 1e-12);
  EXPECT_NEAR(moment.z() / mass_kg, 0.110, 0.0005);
  EXPECT_NEAR(moment.x() / mass_kg, 0.151, 0.0005);
  EXPECT_NEAR(moment.y() / mass_kg, 0.0, 0.001);
}

TEST_F(Description, DepthCameraLooksAheadLevel) {
  const Pose T_base_depth = ReadCar(Model("merlin/merlin.urdf")).T_base_depth;
  EXPECT_LT((T_base_depth.translation() - Eigen::Vector3d(0.30, 0.0, 0.35)).norm(), 1e-12);
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12);  // ahead
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-12);  // right
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);  // down
}

// Table 4.5 of the thesis, read as q_CCD = R q_PMD + t.
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
TEST_F(Description, ColourCameraStandsWhereTable45Says) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  const Pose T_ccd_pmd = car.T_base_color->inverse() * car.T_base_depth;
  const Eigen::Vector3d rotation_vector(0.05058, 0.07940, -0.01120), translation_mm(14.31872, 63.96501, 70.83500);
  EXPECT_LT((T_ccd_pmd.translation() * 1e3 - translation_mm).norm(), 1e-6);
  EXPECT_LT((LogSo3(T_ccd_pmd.linear()) - rotation_vector).norm(), 1e-9);
  // Above the depth camera and behind it, both looking ahead.
  const Eigen::Vector3d offset_base = car.T_base_color->translation() - car.T_base_depth.translation();
  EXPECT_NEAR(offset_base.z(), 0.064, 0.004);
  EXPECT_NEAR(offset_base.x(), -0.071, 0.004);
  EXPECT_GT(car.T_base_color->linear()(0, 2), 0.99);
}

TEST_F(Description, CompassStandsOnItsMastInTheBodysAxes) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  EXPECT_EQ(car.T_base_compass->linear(), Eigen::Matrix3d::Identity());
  const CarLink& mast = Link(car, "compass_mast");
  EXPECT_NEAR(mast.collision[0].size_m.y(), 0.20, 1e-12);
  const double top_m = mast.T_parent_link.translation().z() + mast.collision[0].T_link_shape.translation().z() + 0.10;
  EXPECT_NEAR(car.T_base_compass->translation().z(), top_m, 0.02);
}

TEST_F(Description, CarOutlineIsAsStated) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  double front_m = -1.0, half_width_m = 0.0;
  for (const CarLink& link : car.links)
    for (const CarShape& shape : link.collision) {
      if (shape.kind == CarShape::Kind::kBox && link.parent == "base_link")
        front_m =
            std::max(front_m, (link.T_parent_link * shape.T_link_shape).translation().x() + 0.5 * shape.size_m.x());
      if (link.joint == CarLink::Joint::kContinuous) half_width_m = 0.5 * (car.track_m + shape.size_m.y());
    }
  EXPECT_NEAR(front_m, 0.45, 1e-12);
  EXPECT_NEAR(half_width_m, 0.15, 1e-12);
}

TEST_F(Description, FindsTheJointThatTurnsTheCameras) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  ASSERT_TRUE(car.pan);
  EXPECT_EQ(car.links[car.pan->link].name, "camera_pan");
  EXPECT_FALSE(car.pan->moves);
  EXPECT_DOUBLE_EQ(car.pan->slew_rad_s, 3.2);
  EXPECT_LT((car.pan->T_base_pan.translation() - Eigen::Vector3d(0.245, 0.0, 0.315)).norm(), 1e-12);
  // A quarter to the left: what was 0.055 m ahead of the axis is beside it, and looks to the left.
  const Pose left = car.pan->Turned(car.T_base_depth, std::numbers::pi / 2.0);
  EXPECT_LT((left.translation() - Eigen::Vector3d(0.245, 0.055, 0.35)).norm(), 1e-12);
  EXPECT_LT((left.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((car.pan->Turned(*car.T_base_color, 0.0).matrix() - car.T_base_color->matrix()).norm(), 1e-12);
}

TEST_F(Description, RefusesAJointThatCannotTurnTheCameras) {
  const std::string pan = "<origin xyz=\"0.245 0 0.315\"/><axis xyz=\"0 0 1\"/>";
  const auto with = [&](const std::string& to) { return CarError(Replaced(merlin_, pan, to)); };
  ExpectSays(with("<origin xyz=\"0.245 0 0.315\"/><axis xyz=\"0 1 0\"/>"), {"pan_joint", "upright"});
  ExpectSays(CarError(Replaced(merlin_, "<joint name=\"pan_joint\" type=\"revolute\">",
                               "<joint name=\"pan_joint\" type=\"fixed\">")),
             {"pan_joint", "revolute"});
  ExpectSays(CarError(Replaced(merlin_, "lower=\"-1.5707963267948966\"", "lower=\"0.5\"")),
             {"pan_joint", "lower <= 0"});
  // Upside down: the same joint, counted the other way.
  const std::string below = Replaced(merlin_, pan, "<origin xyz=\"0.245 0 0.315\"/><axis xyz=\"0 0 -1\"/>");
  const CarDescription car =
      ReadCar(File("car.urdf", Replaced(below, "lower=\"-1.5707963267948966\"", "lower=\"-1\"")));
  EXPECT_EQ(car.links[car.pan->link].axis, Eigen::Vector3d::UnitZ());
  EXPECT_DOUBLE_EQ(car.links[car.pan->link].joint_max_rad, 1.0);
  EXPECT_GT(car.pan->Turned(car.T_base_depth, 0.5).translation().y(), 0.0);
}

TEST_F(Description, RefusesWheelsThatMakeNoCar) {
  const auto expect = [this](const std::string& from, const std::string& to, const std::vector<std::string>& says) {
    ExpectSays(CarError(Replaced(merlin_, from, to)), says);
  };
  const std::string rear_left = "xyz=\"0 0.13 0.055\"", rear_right = "xyz=\"0 -0.13 0.055\"";
  expect(rear_right, "xyz=\"0 -0.14 0.055\"", {"car.urdf:", "two axles of one car"});  // one farther out
  expect(rear_left, "xyz=\"0.1 0.13 0.055\"", {"two axles of one car"});               // one farther ahead
  expect(rear_left, "xyz=\"0 0.13 0.065\"", {"two axles of one car"});                 // one farther up
  expect(rear_left, "xyz=\"0 -0.13 0.055\"", {"overlap"});
  expect(rear_left, "xyz=\"nan 0.13 0.055\"", {"car.urdf"});
  expect("<cylinder radius=\"0.055\" length=\"0.04\"/></geometry>\n    </collision>",
         "<cylinder radius=\"0.05\" length=\"0.04\"/></geometry>\n    </collision>",
         {"car.urdf:", "wheel_front_right", "radius", "0.05 m"});
}

// Swapping left and right in the roles would turn the car upside down; so would swapping front and rear.
TEST_F(Description, RefusesWheelsOnTheWrongSide) {
  std::string text = merlin_;
  text = Replaced(text, "<child link=\"wheel_rear_left\"/><origin xyz=\"0 0.13",
                  "<child link=\"wheel_rear_left\"/><origin xyz=\"0 -0.13");
  text = Replaced(text, "<child link=\"wheel_rear_right\"/><origin xyz=\"0 -0.13",
                  "<child link=\"wheel_rear_right\"/><origin xyz=\"0 0.13");
  ExpectSays(CarError(text), {"do not stand as their roles say"});
}

TEST_F(Description, ReadsTheMiddleAngleFromTheKnucklesLimits) {
  // Another limit of one knuckle: the inner angle of 20 deg, or the outer one on its other side, binds the whole car.
  const double inner_rad = std::atan(1.0 / (1.0 / std::tan(20.0 * std::numbers::pi / 180.0) - 0.13 / 0.33));
  const double outer_rad = std::atan(1.0 / (1.0 / std::tan(20.0 * std::numbers::pi / 180.0) + 0.13 / 0.33));
  const std::string left = "lower=\"-0.5190064495436374\" upper=\"0.5190064495436374\"";
  for (const std::string& limits :
       std::vector<std::string>{"lower=\"-0.5190064495436374\" upper=\"" + std::to_string(inner_rad) + "\"",
                                "lower=\"" + std::to_string(-outer_rad) + "\" upper=\"0.5190064495436374\""}) {
    const CarDescription car = ReadCar(File("car.urdf", Replaced(merlin_, left, limits)));
    EXPECT_NEAR(car.steering_max_rad, 20.0 * std::numbers::pi / 180.0, 1e-6) << limits;
  }
  ExpectSays(CarError(Replaced(merlin_, left, "lower=\"0\" upper=\"0.5\"")), {"car.urdf:", "steering limits"});
}

}  // namespace
}  // namespace merlin
