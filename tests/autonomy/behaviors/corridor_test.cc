#include "autonomy/behaviors/corridor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/autonomy/walls.h"

namespace merlin {
namespace {

TEST(Corridor, FindsAxisMiddleWidthAndEndInAnyDirection) {
  for (const double yaw_rad : {0.0, 0.3, -1.2, std::numbers::pi, 2.5}) {
    const Walls walls = EndOpenToTheLeft(yaw_rad);
    const Corridor corridor = SeeCorridor(walls.Map(), walls.Grid(), walls.T_map_plan() * FromXyYaw(0.0, 0.0, 0.1),
                                          {.yaw_rad = yaw_rad + 0.2, .width_m = std::nullopt}, {});
    EXPECT_NEAR(WrapPi(corridor.yaw_rad - yaw_rad), 0.0, 0.02) << yaw_rad;
    ASSERT_TRUE(corridor.left_m && corridor.right_m && corridor.width_m && corridor.front_m) << yaw_rad;
    EXPECT_NEAR(*corridor.width_m, 2.0, 0.05);
    EXPECT_NEAR(corridor.middle_m, -0.2, 0.05);
    EXPECT_NEAR(*corridor.front_m, 4.0, 0.08);
    EXPECT_TRUE(corridor.left_open) << yaw_rad;
    EXPECT_FALSE(corridor.right_open) << yaw_rad;
  }
}

TEST(Corridor, KnowsADeadEnd) {
  const Walls walls = DeadEnd(0.4);
  const Corridor corridor =
      SeeCorridor(walls.Map(), walls.Grid(), walls.T_map_plan(), {.yaw_rad = 0.4, .width_m = {}}, {});
  ASSERT_TRUE(corridor.front_m);
  EXPECT_FALSE(corridor.left_open);
  EXPECT_FALSE(corridor.right_open);
}

TEST(Corridor, KeepsItsDistanceFromTheOnlyWallInSight) {
  Walls walls(0.0);
  walls.Add(-2.0, 0.7, 5.0, 0.7);
  const CorridorHint wide{.yaw_rad = 0.0, .width_m = 3.0};
  EXPECT_NEAR(SeeCorridor(walls.Map(), walls.Grid(), Pose::Identity(), wide, {}).middle_m, 0.7 - 1.5, 0.03);
  const CorridorHint unknown{.yaw_rad = 0.0, .width_m = std::nullopt};
  EXPECT_NEAR(SeeCorridor(walls.Map(), walls.Grid(), Pose::Identity(), unknown, {}).middle_m, 0.7 - 1.0, 0.03);
}

TEST(Corridor, TakesABoxInTheWayForNoEndWall) {
  Walls walls(0.0);
  walls.Add(-2.0, 1.0, 6.0, 1.0);
  walls.Add(-2.0, -1.0, 6.0, -1.0);
  walls.Add(2.0, -0.2, 2.0, 0.2);
  EXPECT_FALSE(SeeCorridor(walls.Map(), walls.Grid(), Pose::Identity(), {}, {}).front_m);
}

TEST(Corridor, KeepsTheHintWhereNothingIsSeen) {
  const Corridor corridor =
      SeeCorridor(VoxelMap({}), OccupancyGrid({}), Pose::Identity(), {.yaw_rad = 0.7, .width_m = 2.0}, {});
  EXPECT_DOUBLE_EQ(corridor.yaw_rad, 0.7);
  EXPECT_DOUBLE_EQ(corridor.middle_m, 0.0);
  EXPECT_FALSE(corridor.left_m || corridor.right_m || corridor.front_m);
}

}  // namespace
}  // namespace merlin
