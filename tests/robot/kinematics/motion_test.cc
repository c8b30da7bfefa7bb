#include "robot/kinematics/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/robot/kinematics/car.h"

namespace merlin {
namespace {

using std::numbers::pi;

TEST(Path, IsTheWheelsCircumferenceForAWheelTurnOfCounts) {
  EXPECT_NEAR(Path_m(Car(), 5120, 0.0), 2.0 * pi * 0.055, 1e-12);  // ten motor turns are one of the wheel
  EXPECT_NEAR(Path_m(Car(), -5120, 0.0), -2.0 * pi * 0.055, 1e-12);
  EXPECT_EQ(Path_m(Car(), 0, 0.3), 0.0);
  // In a turn the four wheels roll farther than the middle of the rear axle moves.
  EXPECT_NEAR(Path_m(Car(), 5120, -0.4), 2.0 * pi * 0.055 / MeanOfFourWheels(Car(), 0.4), 1e-9);
}

TEST(ShaftSpeed, IsTurnsOverTime) {
  EXPECT_NEAR(ShaftSpeed_rad_s(Car().drivetrain, -256, 0.25), -4.0 * pi, 1e-12);
  EXPECT_TRUE(std::isfinite(ShaftSpeed_rad_s({}, 3, 0.1)));
}

TEST(Turn, IsTheAngleOfTheArc) {
  const double R = 0.33 / std::tan(0.3);
  EXPECT_NEAR(Turn_rad(Car(), 2.0 * pi * R, 0.3), 2.0 * pi, 1e-12);
  EXPECT_NEAR(Turn_rad(Car(), -0.5, 0.3), -0.5 / R, 1e-12) << "backwards with the wheels to the left turns right";
}

// The same motion as the sum of many short straight steps.
Pose SumOfSteps(double path_m, double turn_rad) {
  constexpr int kSteps = 20000;
  double x = 0.0, y = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double yaw_rad = turn_rad * (i + 0.5) / kSteps;
    x += path_m / kSteps * std::cos(yaw_rad);
    y += path_m / kSteps * std::sin(yaw_rad);
  }
  return FromXyYaw(x, y, turn_rad);
}

TEST(ArcMotion, IsTheSumOfManyShortSteps) {
  for (const double path_m : {-1.0, 1e-9, 0.7, 3.0})
    for (const double turn_rad : {-2.0 * pi, -pi, -0.3, -0.0011, -0.0009, -1e-9, 0.0, 1e-9, 0.0009, 0.0011, 1.0, pi})
      EXPECT_TRUE(ArcMotion(path_m, turn_rad).isApprox(SumOfSteps(path_m, turn_rad), 1e-8))
          << path_m << " " << turn_rad;
}

TEST(ArcAhead, IsACircleOfTheCarsRadius) {
  const auto straight = ArcAhead(Car(), 0.0, 1.0);
  EXPECT_NEAR(straight.back().x(), 1.0, 0.051);
  EXPECT_EQ(straight.back().y(), 0.0);
  EXPECT_EQ(ArcAhead(Car(), 0.3, 0.0).size(), 1u);
  const double radius_m = 0.33 / std::tan(0.3);
  for (const double length_m : {3.0, -3.0})
    for (const double side : {1.0, -1.0})
      for (const Eigen::Vector2d& p : ArcAhead(Car(), side * 0.3, length_m))
        EXPECT_NEAR((p - Eigen::Vector2d(0.0, side * radius_m)).norm(), radius_m, 0.03);
  EXPECT_EQ(ArcAhead(Car(), 9.0, 1.0).back(), ArcAhead(Car(), Car().steering_max_rad, 1.0).back());
}

TEST(ArcAhead, BacksToTheSideThatTheWheelsPointTo) {
  const auto arc = ArcAhead(Car(), 0.3, -0.5);
  EXPECT_LT(arc.back().x(), -0.4);
  EXPECT_GT(arc.back().y(), 0.05);
  // The mirror image of the arc ahead, about the rear axle.
  const auto ahead = ArcAhead(Car(), 0.3, 0.5);
  ASSERT_EQ(arc.size(), ahead.size());
  for (std::size_t i = 0; i < arc.size(); ++i) EXPECT_NEAR(arc[i].y(), ahead[i].y(), 0.01);
}

}  // namespace
}  // namespace merlin
