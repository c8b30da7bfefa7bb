#include "perception/heading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace merlin {
namespace {

using std::numbers::pi;

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

TEST(Heading, IgnoresADistortedMagneticField) {
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

TEST(Heading, TrustsTheCompassAgainAfterTheWheelsWereWrong) {
  Heading heading({});
  for (int i = 0; i < 200; ++i) heading.Update(FromSeconds(0.1 * i), 1.0, 0.0);
  for (int i = 200; i < 900; ++i) heading.Update(FromSeconds(0.1 * i), 2.0, 0.0);  // the car was turned by hand
  EXPECT_TRUE(heading.bent());
  for (int i = 900; i < 4000; ++i) heading.Update(FromSeconds(0.1 * i), 2.0, 0.0);
  EXPECT_NEAR(heading.Yaw_rad(0.0), 2.0, 0.05);
  EXPECT_FALSE(heading.bent());
}

// A lap of three minutes with the drift of odometry as measured in the twin at 0.5 m/s, 2.4 mrad per root of a second,
// and a compass with noise of 0.5 deg.
TEST(Heading, TrustsATrueCompassWhereOdometryDriftsAsMeasured) {
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 10u}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> drift(0.0, 0.0024 * std::sqrt(0.1)), noise(0.0, 0.0087);
    Heading heading({});
    double odometry_yaw_rad = 0.0, worst_rad = 0.0;
    for (int i = 0; i < 1800; ++i) {
      odometry_yaw_rad += drift(random);
      heading.Update(FromSeconds(0.1 * i), noise(random), odometry_yaw_rad);
      if (i > 50) worst_rad = std::max(worst_rad, std::abs(heading.Yaw_rad(odometry_yaw_rad)));
      EXPECT_FALSE(heading.bent()) << seed << ", " << i;
    }
    EXPECT_LT(worst_rad, 0.02) << seed;  // 1.1 deg
  }
}

TEST(Heading, BecomesLessCertainWithoutReadings) {
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
