#include "robot/kinematics/ackermann.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/robot/kinematics/car.h"

namespace merlin {
namespace {

using std::numbers::pi;

TEST(Curvature, IsThatOfACircleAroundAPointOnTheRearAxle) {
  // At 45 degrees the radius is the wheelbase.
  EXPECT_NEAR(Curvature_1_m(Car(), pi / 4.0), 1.0 / 0.33, 1e-12);
  EXPECT_NEAR(Curvature_1_m(Car(), -pi / 4.0), -1.0 / 0.33, 1e-12);
  EXPECT_EQ(Curvature_1_m(Car(), 0.0), 0.0);
  EXPECT_NEAR(Curvature_1_m(Car(), 1e-9) * 0.33, 1e-9, 1e-18);
  EXPECT_TRUE(std::isnan(Curvature_1_m(Car(), std::numeric_limits<double>::quiet_NaN())));
}

TEST(WheelsAngleForCurvature, IsTheInverse) {
  for (const double wheels_rad : {-1.2, -0.4, -1e-9, 0.0, 1e-9, 0.1, 0.43, 1.5})
    EXPECT_NEAR(WheelsAngleForCurvature_rad(Car(), Curvature_1_m(Car(), wheels_rad)), wheels_rad, 1e-12);
}

TEST(ServoAngle, DiffersFromTheWheelsByTheCalibratedOffset) {
  CarDescription car = Car();
  EXPECT_EQ(ServoAngle_rad(car, 0.2), 0.2);
  EXPECT_EQ(WheelsAngle_rad(car, 0.2), 0.2);
  car.steering_offset_rad = 0.05;  // the wheels stand left of what the servo reports
  EXPECT_DOUBLE_EQ(WheelsAngle_rad(car, 0.1), 0.15);
  EXPECT_DOUBLE_EQ(ServoAngle_rad(car, 0.15), 0.1);
}

TEST(FrontWheelAngle, PointsEachWheelAcrossTheLineToTheCentre) {
  for (const double deg : {-25.0, -10.0, -1e-6, 1e-6, 10.0, 25.0, 40.0}) {
    const double wheels_rad = deg * pi / 180.0, R = 0.33 / std::tan(wheels_rad);  // the centre is at (0, R)
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const double y = side == Side::kLeft ? 0.1 : -0.1, angle_rad = FrontWheelAngle_rad(Car(), wheels_rad, side);
      // The wheel rolls along its own direction, at right angles to the line from the centre.
      const double along = std::cos(angle_rad) * 0.33 + std::sin(angle_rad) * (y - R);
      EXPECT_NEAR(along / std::hypot(0.33, y - R), 0.0, 1e-9) << deg;
      EXPECT_LT(std::abs(angle_rad), pi / 2.0);
    }
  }
  EXPECT_EQ(FrontWheelAngle_rad(Car(), 0.0, Side::kLeft), 0.0);
  EXPECT_GT(FrontWheelAngle_rad(Car(), 0.3, Side::kLeft), 0.3) << "the inner wheel turns more";
  EXPECT_LT(FrontWheelAngle_rad(Car(), 0.3, Side::kRight), 0.3);
}

TEST(WheelMeanRatio, IsOneStraightAheadAndFollowsTheGeometryInATurn) {
  EXPECT_DOUBLE_EQ(WheelMeanRatio(Car(), 0.0), 1.0);
  for (const double deg : {1e-6, 1.0, 5.0, 10.0, 25.0}) {
    const double wheels_rad = deg * pi / 180.0;
    EXPECT_NEAR(WheelMeanRatio(Car(), wheels_rad), MeanOfFourWheels(Car(), wheels_rad), 1e-6) << deg;
    EXPECT_DOUBLE_EQ(WheelMeanRatio(Car(), -wheels_rad), WheelMeanRatio(Car(), wheels_rad));
  }
  EXPECT_NEAR(WheelMeanRatio(Car(), 10.0 * pi / 180.0), 1.008, 5e-4);
}

TEST(ShaftTurnPerMetre, IsTheGearOverTheWheelAndMoreInATurn) {
  EXPECT_NEAR(ShaftTurnPerMetre_rad_m(Car(), 0.0), 10.0 / 0.055, 1e-9);  // a metre is 1/0.055 rad of the wheel
  EXPECT_NEAR(ShaftTurnPerMetre_rad_m(Car(), -0.4), 10.0 / 0.055 * MeanOfFourWheels(Car(), 0.4), 1e-9);
}

}  // namespace
}  // namespace merlin
