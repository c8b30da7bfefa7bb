#include "slam/map/occupancy_grid.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace merlin
