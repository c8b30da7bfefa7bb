#include "slam/map/occupancy_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin {
namespace {

using Cell = OccupancyGrid::Cell;

void Look(OccupancyGrid& grid, const std::vector<Eigen::Vector3f>& at_base, const Pose& T_map_base = Pose::Identity()) {
  std::vector<Point> points;
  for (const auto& p : at_base) points.push_back({.position = p, .sigma_m = 0.01f});
  grid.Insert(points, {0.0f, 0.0f, 0.35f}, T_map_base);
}

TEST(OccupancyGrid, IsUnknownUntilSomethingWasSeen) {
  OccupancyGrid grid({});
  EXPECT_EQ(grid.At({0.0, 0.0}), Cell::kUnknown);
  Look(grid, {});
  EXPECT_EQ(grid.At({1.0, 0.0}), Cell::kUnknown);
}

TEST(OccupancyGrid, MarksTheRayFreeAndItsEndOccupied) {
  OccupancyGrid grid({});
  Look(grid, {{2.02f, 0.02f, 0.35f}});
  EXPECT_EQ(grid.At({2.02, 0.02}), Cell::kOccupied);
  for (double x = 0.02; x < 1.95; x += 0.05) EXPECT_EQ(grid.At({x, 0.02}), Cell::kFree) << x;
  EXPECT_EQ(grid.At({2.1, 0.02}), Cell::kUnknown);
  EXPECT_EQ(grid.At({1.0, 0.3}), Cell::kUnknown);
}

TEST(OccupancyGrid, DoesNotTakeFloorOrCeilingForAnObstacle) {
  OccupancyGrid grid({});
  Look(grid, {{2.0f, 0.0f, 0.0f}, {2.0f, 1.0f, 2.4f}});
  EXPECT_NE(grid.At({2.0, 0.0}), Cell::kOccupied);
  EXPECT_NE(grid.At({2.0, 1.0}), Cell::kOccupied);
}

TEST(OccupancyGrid, FreesACellWhenTheObstacleHasGone) {
  OccupancyGrid grid({});
  Look(grid, {{1.02f, 0.02f, 0.35f}});
  EXPECT_EQ(grid.At({1.02, 0.02}), Cell::kOccupied);
  for (int i = 0; i < 5; ++i) Look(grid, {{3.02f, 0.02f, 0.35f}});
  EXPECT_EQ(grid.At({1.02, 0.02}), Cell::kFree);
}

TEST(OccupancyGrid, LeavesOutWhatIsNotFiniteOrAbsurdlyFar) {
  OccupancyGrid grid({});
  Look(grid, {{std::nanf(""), 0.0f, 0.35f}, {1e9f, 0.0f, 0.35f}});
  EXPECT_LT(grid.width(), 1000);
}

TEST(OccupancyGrid, GrowsAndKeepsWhatItKnew) {
  OccupancyGrid grid({});
  Look(grid, {{1.02f, 0.02f, 0.35f}});
  Look(grid, {{1.02f, 0.02f, 0.35f}}, FromXyYaw(-40.0, 30.0, 0.0));
  Look(grid, {{1.02f, 0.02f, 0.35f}}, FromXyYaw(40.0, -30.0, 0.0));
  EXPECT_EQ(grid.At({1.02, 0.02}), Cell::kOccupied);
  EXPECT_EQ(grid.At({-38.98, 30.02}), Cell::kOccupied);
  EXPECT_EQ(grid.At({41.02, -29.98}), Cell::kOccupied);
  EXPECT_EQ(grid.At({0.5, 0.02}), Cell::kFree);
}

constexpr Footprint kBody{.front_m = 0.45, .rear_m = 0.1, .half_width_m = 0.15, .height_m = 0.3};

TEST(OccupancyGrid, KnowsThatTheGroundBelowTheCarIsFree) {
  for (const double yaw_rad : {0.0, 0.7, std::numbers::pi, -1.6}) {
    const Pose T_map_base = FromXyYaw(-0.31, 0.42, yaw_rad);
    OccupancyGrid grid({});
    grid.Cover(kBody, T_map_base);
    for (double x = -1.0; x < 1.0; x += 0.01)
      for (double y = -1.0; y < 1.0; y += 0.01) {
        const Cell cell = grid.At(Eigen::Vector2d((T_map_base * Eigen::Vector3d(x, y, 0.0)).head<2>()));
        const double outside_m = std::max({x - kBody.front_m, -kBody.rear_m - x, std::abs(y) - kBody.half_width_m});
        if (std::abs(outside_m - 0.05) <= 0.09) continue;  // a cell counts by its middle, at most 0.036 m away
        EXPECT_EQ(cell, outside_m < 0.0 ? Cell::kFree : Cell::kUnknown) << x << ' ' << y;
      }
  }
}

TEST(OccupancyGrid, BelievesWhatItSawBelowTheCarAndWhatItSeesThereLater) {
  const Eigen::Vector2d seen_before(0.22, 0.02), seen_after(0.32, 0.02);
  const auto occupied = [](const Eigen::Vector2d& p) {
    return std::vector<Eigen::Vector3f>{{static_cast<float>(p.x()), static_cast<float>(p.y()), 0.35f}};
  };
  OccupancyGrid grid({});
  Look(grid, occupied(seen_before), FromXyYaw(0.0, 0.0, 0.0));
  for (int i = 0; i < 100; ++i) grid.Cover(kBody, Pose::Identity());
  EXPECT_EQ(grid.At(seen_before), Cell::kOccupied);
  EXPECT_EQ(grid.At(seen_after), Cell::kFree);
  Look(grid, occupied(seen_after));
  EXPECT_EQ(grid.At(seen_after), Cell::kOccupied) << "one look counts for more than standing there for long";
}

TEST(OccupancyGrid, IsNotCoveredByACarWithoutExtent) {
  OccupancyGrid grid({});
  grid.Cover({}, Pose::Identity());
  EXPECT_EQ(grid.width(), 0);
}

}  // namespace
}  // namespace merlin
