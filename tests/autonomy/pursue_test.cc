#include "autonomy/pursue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "robot/kinematics/limits.h"
#include "tests/autonomy/car.h"
#include "tests/autonomy/toy_car.h"

namespace merlin {
namespace {

std::vector<Eigen::Vector2d> Line(double x0, double x1, double y) {
  std::vector<Eigen::Vector2d> path;
  const double step_m = std::copysign(0.05, x1 - x0);
  for (int i = 0; i <= std::lround((x1 - x0) / step_m); ++i) path.emplace_back(x0 + i * step_m, y);
  return path;
}

TEST(RestOfPath, BeginsAtTheNearestPointInTheBaseFrame) {
  const auto rest = RestOfPath(Line(0.0, 2.0, 1.0), FromXyYaw(1.01, 0.0, std::numbers::pi / 2.0));
  ASSERT_EQ(rest.size(), 21u);
  EXPECT_TRUE(rest.front().isApprox(Eigen::Vector2d(1.0, 0.01), 1e-9)) << "one metre ahead, a centimetre to the left";
  EXPECT_TRUE(rest.back().isApprox(Eigen::Vector2d(1.0, -0.99), 1e-9));
  EXPECT_EQ(RestOfPath(Line(0.0, 2.0, 0.0), FromXyYaw(9.0, 0.0, 0.0)).size(), 1u);
}

TEST(Pursue, SteersOnTheCircleThroughTheTarget) {
  // A circle that is tangent to the x axis at the origin and has its centre at (0, 2).
  for (const double ahead : {1.0, -1.0}) {
    const Eigen::Vector2d target(ahead * 2.0 * std::sin(0.5), 2.0 * (1.0 - std::cos(0.5)));
    const Pursuit pursuit =
        Pursue(Car(), std::span(&target, 1), ahead > 0.0 ? Direction::kForwards : Direction::kBackwards, 0.9);
    EXPECT_NEAR(std::tan(pursuit.steering_rad) / 0.33, 1.0 / 2.0, 1e-9) << "left, whether ahead or behind";
    for (const Eigen::Vector2d& p : pursuit.path_base) {
      EXPECT_NEAR((p - Eigen::Vector2d(0.0, 2.0)).norm(), 2.0, 0.02);
      EXPECT_GE(ahead * p.x(), 0.0);
    }
    EXPECT_EQ(pursuit.path_base.back(), target);
  }
}

TEST(Pursue, StaysWithinTheLimitsOfTheCar) {
  for (const Eigen::Vector2d& target :
       {Eigen::Vector2d(0.0, 0.5), Eigen::Vector2d(0.01, -0.01), Eigen::Vector2d(0.0, 0.0)})
    EXPECT_LE(std::abs(Pursue(Car(), std::span(&target, 1), Direction::kForwards, 0.9).steering_rad),
              Car().steering_max_rad);
}

TEST(Pursue, BringsTheCarBackToThePathInBothDirections) {
  for (const double ahead : {1.0, -1.0}) {
    const Direction direction = ahead > 0.0 ? Direction::kForwards : Direction::kBackwards;
    const auto path_map = Line(0.0, ahead * 6.0, 0.0);
    ToyCar car{.y_m = 0.3, .yaw_rad = 0.2};
    for (int i = 0; i < 200; ++i) {
      const Pursuit pursuit = Pursue(Car(), RestOfPath(path_map, car.T_map_base()), direction, 0.9);
      car.Drive({.speed_m_s = ahead * 0.4, .steering_rad = pursuit.steering_rad, .valid_for = Duration(1)}, 0.05);
    }
    EXPECT_NEAR(car.x_m, ahead * 4.0, 0.2);
    EXPECT_NEAR(car.y_m, 0.0, 0.01);
    EXPECT_NEAR(car.yaw_rad, 0.0, 0.02);
  }
}

TEST(PathLength, EndsWhereThePathEnds) {
  EXPECT_NEAR(Length_m(Line(0.2, 2.0, 0.0), Direction::kForwards), 2.0, 1e-9);
  EXPECT_NEAR(Length_m(Line(-0.2, -2.0, 0.0), Direction::kBackwards), 2.0, 1e-9);
  const Eigen::Vector2d passed(-0.1, 0.0);
  EXPECT_LT(Length_m(std::span(&passed, 1), Direction::kForwards), 0.0);
  EXPECT_GT(Length_m(std::span(&passed, 1), Direction::kBackwards), 0.0);
}

}  // namespace
}  // namespace merlin
