#include "perception/odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/perception/car.h"

namespace merlin {
namespace {

using std::numbers::pi;

// Path of each wheel on a circle about a point on the rear axle's line, from plane geometry; mean over the rear middle's.
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

TEST(Heading, IsUnknownBeforeTheFirstReading) { EXPECT_TRUE(std::isinf(Heading({}).Sigma_rad(Time{0}, 0.0))); }

TEST(Heading, AveragesReadingsAtRestAsIndependentOnesAcrossPi) {
  HeadingConfig config;
  config.drift_rad_per_sqrt_s = 0.0;
  Heading heading(config);
  for (int i = 0; i < 100; ++i) heading.Update(FromSeconds(0.1 * i), WrapPi(pi + (i % 2 ? 0.01 : -0.01)), 0.5);
  EXPECT_NEAR(std::abs(heading.Yaw_rad(0.5)), pi, 2e-3);
  EXPECT_NEAR(heading.Sigma_rad(FromSeconds(9.9), 0.5), config.compass_sigma_rad / 10.0, 1e-6);  // sigma / sqrt(n)
}

// A minute of readings at 10 Hz with noise of one degree; between 20 and 30 s a field bent by 0.1 rad.
double WorstError_rad(const HeadingConfig& config, double bend_rad, bool* was_bent) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.0175);
  Heading heading(config);
  double worst_rad = 0.0;
  for (int i = 0; i < 600; ++i) {
    const double bend = i >= 200 && i < 300 ? bend_rad : 0.0;
    heading.Update(FromSeconds(0.1 * i), WrapPi(3.0 + bend + noise(random)), 0.0);
    if (i > 100) worst_rad = std::max(worst_rad, std::abs(WrapPi(heading.Yaw_rad(0.0) - 3.0)));
    if (i == 280) *was_bent = heading.bent();
  }
  EXPECT_FALSE(heading.bent());
  return worst_rad;
}

TEST(Heading, IsNotBentByAFieldThatIs) {
  bool was_bent = false;
  const double undisturbed_rad = WorstError_rad({}, 0.0, &was_bent);
  EXPECT_FALSE(was_bent);
  for (const double bend_rad : {0.1, -0.3, 3.0}) {
    EXPECT_LT(WorstError_rad({}, bend_rad, &was_bent), undisturbed_rad + 0.004) << bend_rad;
    EXPECT_TRUE(was_bent);
  }
  // What it would do without.
  EXPECT_GT(WorstError_rad({.bend_sigmas = 100.0}, 0.1, &was_bent), undisturbed_rad + 0.02);
}

TEST(Heading, BelievesTheCompassInTheEndWhenTheWheelsWereWrong) {
  Heading heading({});
  for (int i = 0; i < 200; ++i) heading.Update(FromSeconds(0.1 * i), 1.0, 0.0);
  for (int i = 200; i < 900; ++i) heading.Update(FromSeconds(0.1 * i), 2.0, 0.0);  // the car was turned by hand
  EXPECT_TRUE(heading.bent());
  for (int i = 900; i < 4000; ++i) heading.Update(FromSeconds(0.1 * i), 2.0, 0.0);
  EXPECT_NEAR(heading.Yaw_rad(0.0), 2.0, 0.05);
  EXPECT_FALSE(heading.bent());
}

TEST(Heading, GrowsLessSureWithoutReadings) {
  const HeadingConfig config;
  Heading heading(config);
  heading.Update(Time{0}, 1.0, 0.0);
  const double expected =
      std::hypot(config.compass_sigma_rad, config.drift_per_turn * 2.0, config.drift_rad_per_sqrt_s * 10.0);
  EXPECT_NEAR(heading.Sigma_rad(FromSeconds(100.0), 2.0), expected, 1e-12);  // 100 s and a turn of 2 rad later
}

TEST(Heading, FollowsTheWheelsBetweenReadings) {
  Heading heading({});
  heading.Update(Time{0}, 1.0, 0.2);
  EXPECT_NEAR(heading.Yaw_rad(0.2 + 0.7), 1.7, 1e-12);
}

}  // namespace
}  // namespace merlin
