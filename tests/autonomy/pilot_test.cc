#include "autonomy/pilot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/autonomy/car.h"

namespace merlin {
namespace {

// A corridor along x, 2 m wide, its middle at y = 0, as the local map of a SLAM that stands at a pose.
Slam InCorridor(const Pose& T_map_base) {
  Slam slam({});
  Observation observation;
  observation.yaw_rad = 0.0;
  observation.yaw_sigma_rad = 1e-4;
  observation.camera_base = {0.3f, 0.0f, 0.35f};
  for (double x = -3.0; x < 6.0; x += 0.05)
    for (double z = 0.05; z < 1.3; z += 0.05)
      for (const double y : {-1.0, 1.0}) {
        const Eigen::Vector3d p = T_map_base.inverse() * Eigen::Vector3d(x, y, z);
        observation.points_base.push_back({.position = p.cast<float>(), .sigma_m = 0.01f});
      }
  observation.yaw_rad = Yaw(T_map_base);
  slam.Update(observation);
  return slam;
}

Observation Quiet() {
  Observation observation;
  observation.stamp = FromSeconds(1.0);
  return observation;
}

TEST(Pilot, SteersBackTowardsTheMiddle) {
  // The map frame begins where mapping does: offsets are put into the observation instead.
  for (const double offset_m : {-0.3, 0.3}) {
    const Slam slam = InCorridor(FromXyYaw(0.0, offset_m, 0.0));
    Pilot pilot(Car(), {}, {});
    const Decision decision = pilot.Decide(Quiet(), Pose::Identity(), slam);
    EXPECT_DOUBLE_EQ(decision.command.speed_m_s, PilotConfig{}.speed_m_s);
    EXPECT_GT(decision.command.steering_rad * -offset_m, 0.01) << offset_m;
    EXPECT_LE(std::abs(decision.command.steering_rad), Car().steering_max_rad);
    EXPECT_GT(decision.command.valid_for, Duration(0));
  }
}

TEST(Pilot, DrivesStraightInTheMiddle) {
  const Slam slam = InCorridor(Pose::Identity());
  Pilot pilot(Car(), {}, {});
  EXPECT_NEAR(pilot.Decide(Quiet(), Pose::Identity(), slam).command.steering_rad, 0.0, 0.02);
}

TEST(Pilot, StandsWithoutAPoseAndBeforeAnObstacle) {
  const Slam slam = InCorridor(Pose::Identity());
  Pilot pilot(Car(), {}, {});
  EXPECT_EQ(pilot.Decide(Quiet(), std::nullopt, slam).command.speed_m_s, 0.0);
  Observation observation = Quiet();
  for (int i = 0; i < 20; ++i)
    observation.points_base.push_back({.position = {0.8f, 0.01f * i - 0.1f, 0.3f}, .sigma_m = 0.01f});
  const Decision decision = pilot.Decide(observation, Pose::Identity(), slam);
  EXPECT_EQ(decision.command.speed_m_s, 0.0);
  EXPECT_EQ(decision.doing, "waits for an obstacle");
}

TEST(Pilot, LooksForObstaclesWhereItWillDriveNotWhereItWants) {
  // Half a metre left of the middle, a box right before the bumper: beside the middle line, but on the way to it.
  const Slam slam = InCorridor(FromXyYaw(0.0, 0.5, 0.0));
  Pilot pilot(Car(), {}, {});
  Observation observation = Quiet();
  for (int i = 0; i < 20; ++i)
    observation.points_base.push_back({.position = {0.8f, 0.01f * i - 0.1f, 0.3f}, .sigma_m = 0.01f});
  EXPECT_EQ(pilot.Decide(observation, Pose::Identity(), slam).command.speed_m_s, 0.0);
}

TEST(Pilot, IsDoneAfterItsLapsAndNotBefore) {
  const Slam slam = InCorridor(Pose::Identity());
  Pilot pilot(Car(), {.behavior = "follow_corridor", .laps = 1}, {});
  Decision decision;
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps + 10; ++i) {  // once round a circle of 5 m radius that begins along x, and 0.78 m on
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    decision =
        pilot.Decide(Quiet(), FromXyYaw(5.0 * std::sin(angle), 5.0 * (1.0 - std::cos(angle)), WrapPi(angle)), slam);
    EXPECT_EQ(decision.done, i >= kSteps + 9) << i;  // 0.7 m beyond
  }
  EXPECT_TRUE(decision.done);
  EXPECT_EQ(decision.command.speed_m_s, 0.0);
}

}  // namespace
}  // namespace merlin
