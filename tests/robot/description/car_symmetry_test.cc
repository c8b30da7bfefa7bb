// Axles with small errors, knuckles without limits, and sensors that a car does not have.
#include <cmath>

#include "tests/robot/description/car_text.h"

namespace merlin {
namespace {

using namespace car_text;

// The rover's left wheel or kingpin moved by this, in mm.
struct Moved {
  const char* at;  // its origin in the URDF
  double x_m, y_m, z_m;
};
constexpr Moved kRearLeft{"xyz=\"-0.2 0.2 -0.05\"", -0.2, 0.2, -0.05},
    kKingpinLeft{"xyz=\"0.3 0.17 -0.02\"", 0.3, 0.17, -0.02},
    kFrontLeft{"xyz=\"0 0.03 -0.03\"", 0.0, 0.03, -0.03};  // seen from the kingpin

std::string With(const Moved& part, double dx_mm, double dy_mm, double dz_mm) {
  return Replaced(
      RoverUrdf(), part.at,
      fmt::format("xyz=\"{} {} {}\"", part.x_m + 1e-3 * dx_mm, part.y_m + 1e-3 * dy_mm, part.z_m + 1e-3 * dz_mm));
}

TEST(CarSymmetry, SaysNothingOfASymmetricCar) { EXPECT_TRUE(Rover(RoverUrdf()).Read().warnings.empty()); }

TEST(CarSymmetry, AveragesAnAxleThatIsOffWithOneWarning) {
  for (const Moved& part : {kRearLeft, kKingpinLeft})
    for (const Eigen::Vector3d& way : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)})
      for (const double off_mm : {0.6, 1.61, 4.9}) {
        SCOPED_TRACE(fmt::format("{} by {} mm along {} {} {}", part.at, off_mm, way.x(), way.y(), way.z()));
        const CarDescription car = Rover(With(part, off_mm * way.x(), off_mm * way.y(), off_mm * way.z())).Read();
        ASSERT_EQ(car.warnings.size(), 1u);
        ExpectSays(car.warnings[0],
                   {"car.urdf", fmt::format("by {:.2f} mm", off_mm), "the means of both sides are used"});
        const double ahead_m = (std::string(part.at) == kRearLeft.at ? -0.5e-3 : 0.5e-3) * off_mm * way.x();
        EXPECT_NEAR(car.wheelbase_m, 0.5 + ahead_m, 1e-5);
        EXPECT_NEAR(car.track_m, 0.4 + 0.5e-3 * off_mm * way.y(), 1e-5);
      }
}

TEST(CarSymmetry, RefusesAnAxleThatIsFiveMillimetresOff) {
  for (const double off_mm : {5.0, 5.2, 10.0, 100.0}) {
    EXPECT_NE(Rover(With(kRearLeft, off_mm, 0, 0)).Error(), "") << off_mm;
    EXPECT_NE(Rover(With(kRearLeft, 0, off_mm, 0)).Error(), "") << off_mm;
    EXPECT_NE(Rover(With(kRearLeft, 0, 0, off_mm)).Error(), "") << off_mm;
    EXPECT_NE(Rover(With(kKingpinLeft, off_mm, 0, 0)).Error(), "") << off_mm;
    EXPECT_NE(Rover(With(kKingpinLeft, 0, off_mm, 0)).Error(), "") << off_mm;
  }
  ExpectFault(With(kRearLeft, 0, 7, 0), {"car.urdf:", "two axles of one car", "less than 5 mm", "7 mm"});
  // The kingpin alone: the wheel stays where it was.
  const std::string pin = Replaced(With(kKingpinLeft, 0, -6, 0), kFrontLeft.at, "xyz=\"0 0.036 -0.03\"");
  ExpectFault(pin, {"joint", "the two steering axes", "less than 5 mm"});
}

std::string Continuous() {
  std::string urdf = RoverUrdf();
  for (const char* side : {"r", "l"})
    urdf = Replaced(urdf, fmt::format("<joint name=\"kingpin_{}\" type=\"revolute\">", side),
                    fmt::format("<joint name=\"kingpin_{}\" type=\"continuous\">", side));
  for (int i = 0; i < 2; ++i)
    urdf = Replaced(urdf, "<limit lower=\"-0.5\" upper=\"0.5\" effort=\"9\" velocity=\"3\"/>", "");
  return urdf;
}

TEST(CarMapping, GivesTheLimitsOfContinuousKnuckles) {
  ExpectFault(Continuous(), {"'kingpin_l' must steer", "steering_limit_rad in car.mapping.yaml"});
  const CarDescription car = Rover(Continuous(), std::string(kRoverMapping) + "steering_limit_rad: 0.5\n").Read();
  // The inner wheel at 0.5 rad: cot(middle) = cot(inner) + track / (2 wheelbase).
  EXPECT_NEAR(1.0 / std::tan(car.steering_max_rad), 1.0 / std::tan(0.5) + 0.34 / (2.0 * 0.5), 1e-6);
  for (const std::size_t knuckle : car.knuckles) EXPECT_EQ(car.links[knuckle].joint, CarLink::Joint::kRevolute);
  // Limits of the URDF's own become narrower, never wider.
  const auto most_rad = [](const std::string& limit) {
    return Rover(RoverUrdf(), std::string(kRoverMapping) + "steering_limit_rad: " + limit + "\n")
        .Read()
        .steering_max_rad;
  };
  EXPECT_DOUBLE_EQ(most_rad("0.9"), car.steering_max_rad);
  EXPECT_LT(most_rad("0.3"), 0.3);
  for (const std::string limit : {"0", "-0.5", "far", "1.6"})
    EXPECT_NE(Rover(Continuous(), std::string(kRoverMapping) + "steering_limit_rad: " + limit + "\n").Error(), "")
        << limit;
}

TEST(CarMapping, LeavesOutTheColourCameraOrTheCompass) {
  const std::string no_color = Replaced(kRoverMapping, "color_camera_optical_frame: eye\n", "");
  const CarDescription blind = Rover(RoverUrdf(), no_color).Read();
  EXPECT_FALSE(blind.T_base_color);
  EXPECT_TRUE(blind.T_base_compass);
  const CarDescription lost = Rover(RoverUrdf(), Replaced(kRoverMapping, "compass_frame: imu\n", "")).Read();
  EXPECT_TRUE(lost.T_base_color);
  EXPECT_FALSE(lost.T_base_compass);
  // A link of the rule's name is a sensor, and one that the mapping names must be there.
  const std::string by_rule =
      Replaced(RoverUrdf(), "</robot>",
               "<link name=\"color_camera_optical_frame\"/>" +
                   Joint("c", "fixed", "chassis", "color_camera_optical_frame", "") + "</robot>");
  EXPECT_TRUE(Rover(by_rule, no_color).Read().T_base_color);
  EXPECT_NE(Rover(RoverUrdf(), Replaced(kRoverMapping, ": eye\n", ": ear\n")).Error(), "");
}

TEST(CarMapping, NamesEveryFaultWithItsLine) {
  std::string mapping = Replaced(kRoverMapping, "compass_frame:", "compas_frame:");
  mapping = Replaced(mapping, ": axle_fr", ": [axle_fr]");
  mapping = Replaced(mapping, "gear: 12", "gear: 0");
  const std::string text = Rover(RoverUrdf(), mapping).Error();
  ExpectSays(text, {"car.mapping.yaml:3: wheel_front_right_joint: expected a text",
                    "car.mapping.yaml:10: compas_frame: unknown key",
                    "car.mapping.yaml:12: drivetrain.gear: expected a positive number"});
}

}  // namespace
}  // namespace merlin
