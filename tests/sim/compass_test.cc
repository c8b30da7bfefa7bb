#include "sim/compass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace merlin::sim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr CompassConfig kNoiseless{.yaw_noise_rad = 0.0, .tilt_noise_rad = 0.0};

Pose Attitude(double roll_rad, double pitch_rad, double yaw_rad) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return Eigen::Translation3d(1, 2, 3) * AngleAxisd(yaw_rad, Vector3d::UnitZ()) *
         AngleAxisd(pitch_rad, Vector3d::UnitY()) * AngleAxisd(roll_rad, Vector3d::UnitX());
}

TEST(Compass, ReadsRollPitchAndYawOfTheBody) {
  for (const double roll : {-1.2, -1e-9, 0.0, 0.7}) {
    for (const double pitch : {-1.5, 0.0, 1e-9, 0.4}) {
      for (const double yaw : {-3.1, -1.0, 0.0, 2.0, 3.14159}) {
        const CompassReading reading = ReadCompass(Attitude(roll, pitch, yaw), kNoiseless, 1, Time{5}, 0);
        EXPECT_NEAR(reading.roll_rad, roll, 1e-12);
        EXPECT_NEAR(reading.pitch_rad, pitch, 1e-12);
        EXPECT_NEAR(reading.yaw_rad, yaw, 1e-12);
        EXPECT_EQ(reading.stamp, Time{5});
      }
    }
  }
}

TEST(Compass, IsPositiveForANoseDownAndALeftTurn) {
  // By hand: a positive pitch about y (left) lifts the tail and points the nose (x) down.
  EXPECT_LT((Attitude(0, 0.1, 0).linear() * Eigen::Vector3d::UnitX()).z(), 0.0);
  EXPECT_NEAR(ReadCompass(Attitude(0, 0.1, 0), kNoiseless, 1, Time{0}, 0).pitch_rad, 0.1, 1e-12);
  EXPECT_NEAR(ReadCompass(FromXyYaw(0, 0, kPi / 2), kNoiseless, 1, Time{0}, 0).yaw_rad, kPi / 2, 1e-12);
}

TEST(Compass, WrapsIntoTheHalfOpenCircle) {
  Pose backwards = Pose::Identity();
  backwards.linear() = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  backwards.linear()(1, 0) = -0.0;  // atan2(-0, -1) is -pi
  EXPECT_EQ(ReadCompass(backwards, kNoiseless, 1, Time{0}, 0).yaw_rad, kPi);

  const CompassConfig noisy{.yaw_noise_rad = 0.2, .tilt_noise_rad = 0.2};
  int negative = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double yaw = ReadCompass(FromXyYaw(0, 0, kPi), noisy, 1, Time{0}, i).yaw_rad;
    ASSERT_GT(yaw, -kPi);
    ASSERT_LE(yaw, kPi);
    ASSERT_GT(std::abs(yaw), kPi - 7 * 0.2);
    negative += yaw < 0;
  }
  EXPECT_NEAR(negative, 500, 4.5 * 15.8);  // binomial sigma
}

TEST(Compass, HasTheNoiseOfItsConfig) {
  constexpr int kReadings = 20000;
  const CompassConfig config{.yaw_noise_rad = 0.02, .tilt_noise_rad = 0.005};
  const double truth[3] = {0.1, -0.2, 0.3};
  double sum[3]{}, square[3]{};
  for (std::uint64_t i = 0; i < kReadings; ++i) {
    const CompassReading reading = ReadCompass(Attitude(truth[0], truth[1], truth[2]), config, 1, Time{0}, i);
    const double values[3] = {reading.roll_rad, reading.pitch_rad, reading.yaw_rad};
    for (int k = 0; k < 3; ++k) {
      sum[k] += values[k] - truth[k];
      square[k] += std::pow(values[k] - truth[k], 2);
    }
  }
  const double sigma[3] = {0.005, 0.005, 0.02};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(sum[k] / kReadings, 0.0, 4.5 * sigma[k] / std::sqrt(kReadings));
    EXPECT_NEAR(std::sqrt(square[k] / kReadings) / sigma[k], 1.0, 4.5 / std::sqrt(2.0 * kReadings));
  }
}

TEST(Compass, RepeatsWithTheSeedAndChangesWithIt) {
  const auto yaw = [](std::uint64_t seed, std::uint64_t index) {
    return ReadCompass(Pose::Identity(), CompassConfig{}, seed, Time{0}, index).yaw_rad;
  };
  EXPECT_EQ(yaw(1, 2), yaw(1, 2));
  EXPECT_NE(yaw(1, 2), yaw(1, 3));
  EXPECT_NE(yaw(1, 2), yaw(2, 2));
}

TEST(Compass, IsTurnedBySteelMostRightAtItAndNotFarAway) {
  CompassConfig config = kNoiseless;
  config.steel = {{.x_m = 2.0, .y_m = -1.0, .reach_m = 0.5, .bend_rad = 0.2}};
  const auto yaw = [&](double x, double y) { return ReadCompass(FromXyYaw(x, y, 0.3), config, 1, Time{0}, 0).yaw_rad; };
  EXPECT_NEAR(yaw(2.0, -1.0), 0.5, 1e-12);
  EXPECT_NEAR(yaw(2.0, -0.5), 0.3 + 0.2 * std::exp(-0.5), 1e-12);
  EXPECT_NEAR(yaw(12.0, -1.0), 0.3, 1e-12);
  config.steel.push_back({.x_m = 2.0, .y_m = -1.0, .reach_m = 3.0, .bend_rad = -0.05});
  EXPECT_NEAR(yaw(2.0, -1.0), 0.45, 1e-12);
}

}  // namespace
}  // namespace merlin::sim
