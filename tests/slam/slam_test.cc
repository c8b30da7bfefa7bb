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
    if (i > 0) T_odom_base.translation().x() += 0.015 * 1.05;  // wheels slip by 5 %, and do not measure sideways motion
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

// Drives 0.9 m while the wheels report `reported` times that. Returns whether slip is detected at the end.
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

TEST(Slam, DistinguishesSlippingWheelsFromRollingOnes) {
  EXPECT_FALSE(EndsSlipping(1.0));
  EXPECT_FALSE(EndsSlipping(1.03));  // an error that calibration leaves
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

TEST(Slam, BeginsItsMapOnlyWithEnoughStructureToRegister) {
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

TEST(Slam, MapsNoFrameThatItCouldNotRegister) {
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
  observation.yaw_rad = 1.5;  // the compass begins to deliver
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

// The map that a drive of 0.9 m along the room leaves. Its frame begins where the drive does.
const Pose kT_world_former = FromXyYaw(-0.5, 0.0, 0.0);
SavedMap FormerMap() {
  Slam slam({});
  for (int i = 0; i <= 60; ++i) EXPECT_TRUE(slam.Update(InRoom(FromXyYaw(-0.5 + 0.015 * i, 0.0, 0.0), 0.05 * i)));
  return slam.Saved();
}

// What a car sees that starts elsewhere in the room, at the i-th frame; its odometry begins at zero.
Pose Later(int i) { return FromXyYaw(0.1 + 0.015 * i, 0.3, 0.2); }
Observation SeenLater(int i) {
  Observation observation = InRoom(Later(i), 0.05 * i);
  observation.T_odom_base = Later(0).inverse() * Later(i);
  return observation;
}

TEST(SlamInAFormerMap, FindsItsPlaceAndGoesOnInThatMapsFrame) {
  const SavedMap former = FormerMap();
  Slam slam({}, {}, former);
  EXPECT_EQ(slam.search(), Slam::Search::kSearching);
  int changes = 0, frames = 0;
  for (; frames <= 60 && changes == 0; ++frames) {
    ASSERT_TRUE(slam.Update(SeenLater(frames)));
    changes += slam.T_map_before().has_value();
  }
  ASSERT_EQ(slam.search(), Slam::Search::kFound);
  EXPECT_GT(slam.search_effort().path_m, 0.7) << "four searches, 0.25 m apart, must agree";
  for (const int last = frames + 10; frames < last; ++frames) {
    const auto T_former_base = slam.Update(SeenLater(frames));
    ASSERT_TRUE(T_former_base);
    EXPECT_FALSE(slam.T_map_before());
    const Pose error = (kT_world_former * *T_former_base).inverse() * Later(frames);
    EXPECT_LT(error.translation().norm(), 0.02);
    EXPECT_LT(std::abs(Yaw(error)), 0.01);
  }
  // The path before is in the same frame, and so are both runs' key frames.
  for (const std::vector<MapPose>& path : {slam.online(), slam.trajectory()})
    EXPECT_LT(((kT_world_former * path.front().T_map_base).inverse() * Later(0)).translation().norm(), 0.03);
  ASSERT_GT(slam.keyframes().size(), former.keyframes.size());
  EXPECT_LT(slam.keyframes()[former.keyframes.size() - 1].path_m, 0.0) << "the former run was before";
  EXPECT_EQ(slam.keyframes()[former.keyframes.size()].path_m, 0.0);
  EXPECT_EQ(slam.loops(), 0) << "it was joined, and closed none";
}

TEST(SlamInAFormerMap, IsTheSameWhetherTheMapWasInAFileOrNot) {
  const SavedMap former = FormerMap(), read = ParseSavedMap(ToBytes(former), "map.slam");
  Slam direct({}, {}, former), from_file({}, {}, read);
  for (int i = 0; i <= 60; ++i)
    ASSERT_EQ(direct.Update(SeenLater(i))->matrix(), from_file.Update(SeenLater(i))->matrix()) << i;
  EXPECT_EQ(from_file.search(), Slam::Search::kFound);
  EXPECT_EQ(ToBytes(direct.Saved()), ToBytes(from_file.Saved()));
}

// Half a turn fits the bare walls as well: a room that is the same from both ends, and no compass.
TEST(SlamInAFormerMap, TakesNoPlaceWhereAnotherFitsToo) {
  Slam slam({}, {}, FormerMap());
  for (int i = 0; i <= 60; ++i) {
    Observation blind = SeenLater(i);
    blind.stamp += std::chrono::seconds(3);
    blind.yaw_sigma_rad = std::numeric_limits<double>::infinity();
    std::erase_if(blind.points_base, [&](const Point& point) {
      const Eigen::Vector3d p_world = Later(i) * point.position.cast<double>();
      return std::abs(p_world.x()) < 1.9 && std::abs(p_world.y()) < 1.4 && p_world.z() > 0.01;  // no pillar
    });
    slam.Update(blind);
  }
  EXPECT_EQ(slam.search(), Slam::Search::kSearching);
}

TEST(SlamInAFormerMap, GivesUpInAForeignPlaceAndKeepsItsOwnMap) {
  SlamConfig config;
  config.search.give_up_s = 1.5;
  Slam slam(config, {}, FormerMap());
  for (int i = 0; i <= 40; ++i) {
    Observation foreign = SeenLater(i);
    for (Point& point : foreign.points_base) point.position.head<2>() *= 1.6f;  // a larger room
    foreign.T_odom_base.translation() *= 1.6;
    ASSERT_TRUE(slam.Update(foreign));
    EXPECT_EQ(slam.search(), i <= 30 ? Slam::Search::kSearching : Slam::Search::kGaveUp) << i;
  }
  EXPECT_GT(slam.keyframes().size(), 5u);
  EXPECT_TRUE(slam.keyframes().front().first_of_run);
  EXPECT_EQ(slam.keyframes().front().T_map_base.translation().head<2>(), Eigen::Vector2d::Zero());
}

}  // namespace
}  // namespace merlin
