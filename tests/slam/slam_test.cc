#include "slam/slam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace merlin {
namespace {

// What a level camera with a full view sees of a 4 x 3 m room with a pillar, as exact points on a grid.
Observation InRoom(const Pose& T_world_base, double time_s) {
  Observation observation;
  observation.stamp = FromSeconds(time_s);
  observation.T_odom_base = T_world_base;
  observation.yaw_rad = Yaw(T_world_base);
  observation.yaw_sigma_rad = 0.001;
  observation.camera_base = {0.0f, 0.0f, 0.35f};
  const auto add = [&](double x, double y, double z) {
    const Eigen::Vector3d p = T_world_base.inverse() * Eigen::Vector3d(x, y, z);
    observation.points_base.push_back({.position = p.cast<float>(), .sigma_m = 0.005f});
  };
  for (double z = 0.05; z < 1.5; z += 0.05) {
    for (double x = -2.0; x <= 2.0; x += 0.05) add(x, -1.5, z), add(x, 1.5, z);
    for (double y = -1.5; y <= 1.5; y += 0.05) add(-2.0, y, z), add(2.0, y, z);
    for (double s = 0.0; s <= 0.3; s += 0.05) add(1.0 + s, 0.9, z), add(1.0, 0.9 + s, z);
  }
  for (double x = -2.0; x <= 2.0; x += 0.1)
    for (double y = -1.5; y <= 1.5; y += 0.1) add(x, y, 0.0);
  return observation;
}

TEST(Slam, CorrectsOdometryThatSlips) {
  Slam slam({});
  Pose T_world_base, T_odom_base = Pose::Identity();
  for (int i = 0; i <= 60; ++i) {
    T_world_base = FromXyYaw(-0.5 + 0.015 * i, 0.2 * std::sin(0.05 * i), 0.3 * std::sin(0.05 * i));
    Observation observation = InRoom(T_world_base, 0.05 * i);
    if (i > 0) T_odom_base.translation().x() += 0.015 * 1.05;  // wheels slip by 5 %, and know nothing of the side
    observation.T_odom_base = T_odom_base;
    ASSERT_TRUE(slam.Update(observation));
    EXPECT_EQ(slam.lost_frames(), 0);
  }
  const Pose T_world_map = FromXyYaw(-0.5, 0.0, 0.0);
  const Pose error = T_world_base.inverse() * T_world_map * slam.trajectory().back().T_map_base;
  EXPECT_LT(error.translation().norm(), 0.02);
  EXPECT_LT(std::abs(Yaw(error)), 0.01);
  EXPECT_EQ(slam.trajectory().size(), 61u);
}

// Drives 0.9 m of which the wheels report `reported` times as much; true: it ends knowing that they slip.
bool EndsSlipping(double reported) {
  Slam slam({});
  Pose T_odom_base = Pose::Identity();
  for (int i = 0; i <= 60; ++i) {
    Observation observation = InRoom(FromXyYaw(-0.5 + 0.015 * i, 0.0, 0.0), 0.05 * i);
    if (i > 0) T_odom_base.translation().x() += 0.015 * reported;
    observation.T_odom_base = T_odom_base;
    EXPECT_TRUE(slam.Update(observation));
  }
  EXPECT_NEAR(slam.online().back().T_map_base.translation().x(), 0.9, 0.05);
  return slam.slipping();
}

TEST(Slam, TellsWheelsThatSlipFromWheelsThatRoll) {
  EXPECT_FALSE(EndsSlipping(1.0));
  EXPECT_FALSE(EndsSlipping(1.03));  // calibration's remains
  EXPECT_TRUE(EndsSlipping(1.3));
  EXPECT_TRUE(EndsSlipping(0.8));  // the car slides on while its wheels are braked
}

TEST(Slam, WaitsForTheHeadingAtTheStartButNotForEver) {
  Slam slam({});
  Observation observation = InRoom(Pose::Identity(), 0.0);
  observation.yaw_sigma_rad = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(slam.Update(observation));
  observation.stamp = FromSeconds(1.0);
  EXPECT_FALSE(slam.Update(observation));
  observation.stamp = FromSeconds(2.0);
  EXPECT_TRUE(slam.Update(observation));
}

TEST(Slam, BeginsItsMapOnlyWithSomethingToHoldOnTo) {
  Slam slam({});
  Observation blind;
  blind.yaw_sigma_rad = 0.001;
  ASSERT_TRUE(slam.Update(blind));
  EXPECT_TRUE(slam.keyframes().empty());
  EXPECT_EQ(slam.lost_frames(), 0);
  ASSERT_TRUE(slam.Update(InRoom(Pose::Identity(), 0.05)));
  ASSERT_TRUE(slam.Update(InRoom(Pose::Identity(), 0.10)));
  EXPECT_TRUE(slam.last().converged);
}

TEST(Slam, MapsNothingItDidNotRecognise) {
  Slam slam({});
  ASSERT_TRUE(slam.Update(InRoom(Pose::Identity(), 0.0)));
  Observation elsewhere = InRoom(Pose::Identity(), 0.05);
  for (Point& point : elsewhere.points_base) point.position.z() += 5.0f;
  elsewhere.T_odom_base = FromXyYaw(0.5, 0.0, 0.0);
  ASSERT_TRUE(slam.Update(elsewhere));
  EXPECT_EQ(slam.keyframes().size(), 1u);
}

TEST(Slam, MapsOnWhereItStandsLostForThreeSeconds) {
  Slam slam({});
  ASSERT_TRUE(slam.Update(InRoom(Pose::Identity(), 0.0)));
  Observation elsewhere = InRoom(Pose::Identity(), 0.0);
  for (Point& point : elsewhere.points_base) point.position.z() += 5.0f;
  elsewhere.T_odom_base = FromXyYaw(0.5, 0.0, 0.0);
  for (int i = 1; i <= 60; ++i) {
    elsewhere.stamp = FromSeconds(0.05 * i);
    ASSERT_TRUE(slam.Update(elsewhere));
    EXPECT_EQ(slam.lost_frames(), i);
  }
  for (int i = 61; i <= 63; ++i) {
    elsewhere.stamp = FromSeconds(0.05 * i);
    const auto pose = slam.Update(elsewhere);
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->translation().x(), 0.5, 0.01);
  }
  EXPECT_EQ(slam.lost_frames(), 0);
  EXPECT_TRUE(slam.last().converged);
  EXPECT_EQ(slam.keyframes().size(), 2u);
}

TEST(Slam, KeepsItsDirectionWhenAHeadingComesLate) {
  Slam slam({});
  Observation observation = InRoom(Pose::Identity(), 0.0);
  observation.yaw_sigma_rad = std::numeric_limits<double>::infinity();
  slam.Update(observation);
  observation.stamp = FromSeconds(2.0);
  ASSERT_TRUE(slam.Update(observation));
  observation.stamp = FromSeconds(2.05);
  observation.yaw_rad = 1.5;  // the compass wakes up
  observation.yaw_sigma_rad = 0.01;
  const auto pose = slam.Update(observation);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(Yaw(*pose), 0.0, 0.005);
}

TEST(Slam, GivesNoPoseForOdometryThatIsNotFinite) {
  Slam slam({});
  Observation observation = InRoom(Pose::Identity(), 0.0);
  observation.T_odom_base.translation().x() = std::nan("");
  EXPECT_FALSE(slam.Update(observation));
}

// Twice round a circle in the room: the second time it knows the place, and the key frames move.
TEST(Slam, CorrectsPosesAndLocalMapAtOnceAndTheGridWithinFortyFrames) {
  constexpr double kRadius_m = 0.5, kStep_m = 0.05;
  SlamConfig config;
  config.loop.apart_m = 2.0;
  config.correction_min_m = 0.0;
  Slam slam(config);
  constexpr int kLookEvery = 4;  // frames
  int renewed = 0, behind = 0;   // frames since the grid last was that of the key frames
  for (int i = 0; i < 140; ++i) {
    const double turned_rad = i * kStep_m / kRadius_m;
    const Pose T_world_base =
        FromXyYaw(kRadius_m * std::sin(turned_rad), -kRadius_m * std::cos(turned_rad), WrapPi(turned_rad));
    Observation observation = InRoom(T_world_base, 0.05 * i);
    int count = 0;
    std::erase_if(observation.points_base, [&count](const Point&) { return ++count % 5 != 0; });
    ASSERT_TRUE(slam.Update(observation));
    if (i % kLookEvery != 0) continue;
    const OccupancyGrid now = slam.BuildOccupancy(), &shown = slam.occupancy();
    bool same = now.width() == shown.width() && now.height() == shown.height() && now.origin_m() == shown.origin_m();
    for (int row = 0; same && row < now.height(); ++row)
      for (int column = 0; same && column < now.width(); ++column) same = now.At(column, row) == shown.At(column, row);
    if (same && behind > 0) ++renewed;
    behind = same ? 0 : behind + kLookEvery;
    ASSERT_LE(behind, static_cast<int>(KeyframeGrid::kFrames)) << i;
  }
  EXPECT_GE(slam.loops(), 1);
  EXPECT_GE(renewed, 1) << "no correction moved anything: the test means nothing";
}

TEST(Slam, SaysThatItIsLostAndDrivesOnByOdometry) {
  Slam slam({});
  ASSERT_TRUE(slam.Update(InRoom(Pose::Identity(), 0.0)));
  Observation blind;
  blind.stamp = FromSeconds(0.05);
  blind.T_odom_base = FromXyYaw(0.02, 0.0, 0.0);
  blind.yaw_sigma_rad = 0.001;
  const auto pose = slam.Update(blind);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation().x(), 0.02, 1e-9);
  EXPECT_EQ(slam.lost_frames(), 1);
  EXPECT_FALSE(slam.last().converged);
}

}  // namespace
}  // namespace merlin
