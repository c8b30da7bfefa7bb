#include "autonomy/avoid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace merlin {
namespace {

constexpr Footprint kCar{.front_m = 0.45, .half_width_m = 0.16};

std::vector<Eigen::Vector2d> Straight() {
  std::vector<Eigen::Vector2d> path;
  for (int i = 0; i < 80; ++i) path.push_back({0.05 * i, 0.0});
  return path;
}

// A facing patch of points, 0.4 m wide and high, with its middle at (x, y, z).
Observation Box(double x, double y, double z, double time_s = 0.0) {
  Observation observation;
  observation.stamp = FromSeconds(time_s);
  for (double dy = -0.2; dy <= 0.2; dy += 0.05)
    for (double dz = -0.2; dz <= 0.2; dz += 0.05)
      observation.points_base.push_back(
          {.position = Eigen::Vector3d(x, y + dy, z + dz).cast<float>(), .sigma_m = 0.01f});
  return observation;
}

TEST(Avoid, MeasuresTheFreeDistanceToABoxFromTheCarsFront) {
  Avoid avoid(kCar, {});
  const auto free_m = avoid.FreeDistance_m(Box(3.0, 0.0, 0.3), Straight());
  ASSERT_TRUE(free_m);
  EXPECT_NEAR(*free_m, 3.0 - 0.45, 0.05);
}

TEST(Avoid, IgnoresWhatIsBesideAboveAndOnTheFloor) {
  Avoid avoid(kCar, {});
  EXPECT_FALSE(
      avoid.FreeDistance_m(Box(2.0, 0.5, 0.3), Straight()));  // its edge is 0.3 m to the side, the car needs 0.24
  EXPECT_FALSE(avoid.FreeDistance_m(Box(2.0, 0.0, 1.0), Straight()));
  EXPECT_FALSE(avoid.FreeDistance_m(Box(2.0, 0.0, -0.15), Straight()));  // up to 0.05 m high
  EXPECT_FALSE(avoid.FreeDistance_m(Observation{}, Straight()));
  EXPECT_FALSE(avoid.FreeDistance_m(Box(2.0, 0.0, 0.3), {}));
}

TEST(Avoid, FollowsThePathAroundACorner) {
  std::vector<Eigen::Vector2d> path;  // a quarter circle to the left, radius 2 m
  for (double a = 0.0; a < 1.57; a += 0.025) path.push_back({2.0 * std::sin(a), 2.0 * (1.0 - std::cos(a))});
  Avoid avoid(kCar, {});
  EXPECT_FALSE(avoid.FreeDistance_m(Box(3.0, 0.0, 0.3), path));
  const auto free_m = avoid.FreeDistance_m(Box(2.0, 2.0, 0.3), path);
  ASSERT_TRUE(free_m);
  EXPECT_NEAR(*free_m, 2.0 * 1.4 - 0.45, 0.25);
}

TEST(Avoid, DoesNotStopForThreePointsOfNoise) {
  Observation observation;
  for (int i = 0; i < 3; ++i) observation.points_base.push_back({.position = {1.0f, 0.0f, 0.3f}, .sigma_m = 0.01f});
  EXPECT_FALSE(Avoid(kCar, {}).FreeDistance_m(observation, Straight()));
}

TEST(Avoid, TakesManySaturatedPixelsAheadForSomethingClose) {
  Observation observation;
  observation.pixel_sr = 1e-4;
  observation.saturated_base.assign(30, Eigen::Vector3f::UnitX());  // 0.003 sr: a few
  EXPECT_FALSE(Avoid(kCar, {}).FreeDistance_m(observation, Straight()));
  observation.saturated_base.assign(50, Eigen::Vector3f::UnitX());
  EXPECT_EQ(Avoid(kCar, {}).FreeDistance_m(observation, Straight()), 0.0);
  observation.saturated_base.assign(50, Eigen::Vector3f(0.8f, 0.6f, 0.0f));  // to the side
  EXPECT_FALSE(Avoid(kCar, {}).FreeDistance_m(observation, Straight()));
}

// A frame in which the area ahead saturates, and after which a shorter exposure may follow.
Observation Glare(double time_s, double driven_m) {
  Observation observation;
  observation.stamp = FromSeconds(time_s);
  observation.T_odom_base = FromXyYaw(driven_m, 0.0, 0.0);
  observation.pixel_sr = 1e-4;
  observation.saturated_base.assign(50, Eigen::Vector3f::UnitX());
  observation.shortest_exposure = false;
  return observation;
}

TEST(Avoid, TakesWhatTheShortExposureMeasuredForWhatSaturatesInTheLongOne) {
  Avoid avoid(kCar, {});
  avoid.FreeDistance_m(Box(2.0, 0.0, 0.3, 0.0), Straight());
  const auto free_m = avoid.FreeDistance_m(Glare(0.1, 0.15), Straight());
  ASSERT_TRUE(free_m);
  EXPECT_NEAR(*free_m, 2.0 - 0.45 - 0.15, 0.05);
}

TEST(Avoid, SeesAFreePathWhereTheShortExposureMeasuredNothingOnIt) {
  Avoid avoid(kCar, {});
  Observation clear;
  avoid.FreeDistance_m(clear, Straight());
  EXPECT_FALSE(avoid.FreeDistance_m(Glare(0.1, 0.0), Straight()));
}

TEST(Avoid, KeepsTheNearerOfBothExposures) {
  Avoid avoid(kCar, {});
  avoid.FreeDistance_m(Box(3.0, 0.0, 0.3, 0.0), Straight());
  Observation both = Glare(0.1, 0.0);
  both.points_base = Box(1.0, 0.0, 0.3).points_base;  // beside the glare
  const auto free_m = avoid.FreeDistance_m(both, Straight());
  ASSERT_TRUE(free_m);
  EXPECT_NEAR(*free_m, 1.0 - 0.45, 0.05);
}

TEST(Avoid, StopsForWhatKeepsSaturatingUnmeasured) {
  Avoid avoid(kCar, {});
  EXPECT_EQ(avoid.FreeDistance_m(Glare(0.0, 0.0), Straight()), 0.0);  // no earlier frame measured anything there
  avoid.FreeDistance_m(Box(3.0, 0.0, 0.3, 0.1), Straight());
  EXPECT_GT(*avoid.FreeDistance_m(Glare(0.6, 0.0), Straight()), 2.0);
  EXPECT_EQ(avoid.FreeDistance_m(Glare(0.7, 0.0), Straight()), 0.0);
}

TEST(Avoid, StopsAtOnceForWhatSaturatesInTheShortestExposure) {
  Avoid avoid(kCar, {});
  avoid.FreeDistance_m(Box(3.0, 0.0, 0.3, 0.0), Straight());
  Observation glare = Glare(0.1, 0.0);
  glare.shortest_exposure = true;
  EXPECT_EQ(avoid.FreeDistance_m(glare, Straight()), 0.0);
}

TEST(Avoid, RemembersAnObstacleThatDropsOutOfSightForAMoment) {
  Avoid avoid(kCar, {});
  ASSERT_TRUE(avoid.FreeDistance_m(Box(2.0, 0.0, 0.3, 0.0), Straight()));
  Observation blind;
  blind.stamp = FromSeconds(0.3);
  blind.T_odom_base = FromXyYaw(0.15, 0.0, 0.0);
  const auto free_m = avoid.FreeDistance_m(blind, Straight());
  ASSERT_TRUE(free_m);
  EXPECT_NEAR(*free_m, 2.0 - 0.45 - 0.15, 0.05);
  blind.stamp = FromSeconds(1.0);
  EXPECT_FALSE(avoid.FreeDistance_m(blind, Straight()));
}

TEST(Avoid, LimitsTheSpeedSoThatBrakingEndsAtTheGap) {
  const AvoidConfig config;
  const Avoid avoid(kCar, config);
  EXPECT_EQ(avoid.SpeedLimit_m_s(std::nullopt), HUGE_VAL);
  EXPECT_EQ(avoid.SpeedLimit_m_s(0.0), 0.0);
  EXPECT_EQ(avoid.SpeedLimit_m_s(config.stop_gap_m), 0.0);
  // v^2 = 2 a s: 0.4 m before the gap, at 0.5 m/s^2.
  EXPECT_NEAR(avoid.SpeedLimit_m_s(config.stop_gap_m + 0.4), std::sqrt(0.4), 1e-12);
}

}  // namespace
}  // namespace merlin
