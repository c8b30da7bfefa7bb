#include "autonomy/corridor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace merlin {
namespace {

// Walls as exact points every 4 cm, 0.1 to 1.3 m high, turned as a whole by an angle.
class Walls {
 public:
  explicit Walls(double yaw_rad) : T_map_plan_(FromXyYaw(0.0, 0.0, yaw_rad)) {}
  void Add(double x0, double y0, double x1, double y1) {
    const double length_m = std::hypot(x1 - x0, y1 - y0);
    for (double s = 0.0; s <= length_m; s += 0.04)
      for (double z = 0.1; z < 1.3; z += 0.04)
        points_.push_back({.position = {static_cast<float>(x0 + (x1 - x0) * s / length_m),
                                        static_cast<float>(y0 + (y1 - y0) * s / length_m), static_cast<float>(z)},
                           .sigma_m = 0.01f});
  }
  VoxelMap Map() const {
    VoxelMap map({});
    map.Insert(points_, T_map_plan_, 0.0);
    return map;
  }
  // What a camera at the plan's origin, free all around, has carved.
  OccupancyGrid Grid() const {
    OccupancyGrid grid({});
    std::vector<Point> points;
    for (const Point& point : points_)
      if (std::abs(point.position.z() - 0.7f) < 0.05f) points.push_back(point);
    for (int i = 0; i < 2; ++i) grid.Insert(points, {0.0f, 0.0f, 0.7f}, T_map_plan_);
    return grid;
  }
  const Pose& T_map_plan() const { return T_map_plan_; }

 private:
  Pose T_map_plan_;
  std::vector<Point> points_;
};

// A corridor 2 m wide, the car 0.2 m left of its middle; its end 4 m ahead, open to the left.
Walls EndOpenToTheLeft(double yaw_rad) {
  Walls walls(yaw_rad);
  walls.Add(-2.0, 0.8, 2.0, 0.8);
  walls.Add(-2.0, -1.2, 4.0, -1.2);
  walls.Add(4.0, -1.2, 4.0, 2.5);
  return walls;
}

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
  Walls walls(0.4);
  walls.Add(-2.0, 1.0, 4.0, 1.0);
  walls.Add(-2.0, -1.0, 4.0, -1.0);
  walls.Add(4.0, -1.0, 4.0, 1.0);
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
