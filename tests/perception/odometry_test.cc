#include "perception/odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/perception/car.h"

namespace merlin {
namespace {

using std::numbers::pi;

// Mean path of the four wheels over that of the middle of the rear axle, on a circle about a point on the axle's line.
double MeanOfFourWheels(double steering_rad) {
  const double R = 0.33 / std::tan(steering_rad);
  double sum = 0.0;
  for (const double x : {0.0, 0.33})
    for (const double y : {-0.13, 0.13}) sum += std::hypot(x, R - y);
  return sum / 4.0 / R;
}

DriveState State(double time_s, double counts, double steering_rad) {
  DriveState state;
  state.stamp = FromSeconds(time_s);
  state.encoder_counts = std::llround(counts);
  state.steering_rad = steering_rad;
  return state;
}

TEST(Odometry, KnowsNothingBeforeTheFirstState) { EXPECT_FALSE(Odometry(Car()).At(Time{0})); }

TEST(Odometry, DrivesStraightForthAndBack) {
  Odometry odometry(Car());
  const double per_metre = 1.0 / Car().MetresPerCount();
  odometry.Update(State(0.0, 1000, 0.0));
  odometry.Update(State(0.1, 1000 + 2.0 * per_metre, 0.0));
  EXPECT_NEAR(odometry.At(FromSeconds(0.1))->translation().x(), 2.0, 1e-4);
  EXPECT_NEAR(odometry.At(FromSeconds(0.05))->translation().x(), 1.0, 1e-4);
  odometry.Update(State(0.2, 1000, 0.0));
  EXPECT_NEAR(odometry.At(FromSeconds(0.2))->translation().norm(), 0.0, 1e-4);
}

TEST(Odometry, ClosesAFullCircleEitherWayRound) {
  for (const double deg : {-20.0, 20.0}) {
    Odometry odometry(Car());
    const double steering_rad = deg * pi / 180.0;
    const double R = 0.33 / std::tan(std::abs(steering_rad));
    const double counts = 2.0 * pi * R * MeanOfFourWheels(std::abs(steering_rad)) / Car().MetresPerCount();
    constexpr int kSteps = 200;
    Pose half = Pose::Identity();
    for (int i = 0; i <= kSteps; ++i) {
      odometry.Update(State(0.02 * i, counts * i / kSteps, steering_rad));
      if (i == kSteps / 2) half = *odometry.At(FromSeconds(0.02 * i));
    }
    const Pose end = *odometry.At(FromSeconds(0.02 * kSteps));
    EXPECT_NEAR(half.translation().y(), std::copysign(2.0 * R, deg),
                1e-3);  // across the circle, on the side steered to
    EXPECT_NEAR(std::abs(Yaw(half)), pi, 1e-3);
    EXPECT_LT(end.translation().norm(), 1e-3);
    EXPECT_NEAR(Yaw(end), 0.0, 1e-3);
  }
}

TEST(Odometry, AddsTheSteeringOffsetToWhatTheServoReports) {
  CarDescription car = Car();
  car.steering_offset_rad = 0.05;
  Odometry with(car), without(Car());
  for (int i = 0; i <= 100; ++i) {
    with.Update(State(0.02 * i, 200.0 * i, 0.15));
    without.Update(State(0.02 * i, 200.0 * i, 0.20));
  }
  EXPECT_TRUE(with.At(FromSeconds(2.0))->isApprox(*without.At(FromSeconds(2.0)), 1e-12));
}

}  // namespace
}  // namespace merlin
