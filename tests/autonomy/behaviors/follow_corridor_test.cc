#include "autonomy/behaviors/follow_corridor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/autonomy/walls.h"

namespace merlin {
namespace {

using std::numbers::pi;

Intent Decide(FollowCorridor& behavior, const Walls& walls, const Pose& T_map_base, bool taken_over = false) {
  const VoxelMap map = walls.Map();
  const OccupancyGrid grid = walls.Grid();
  const Observation observation;
  return behavior.Decide(
      {.observation = observation, .T_map_base = T_map_base, .local_map = map, .grid = grid, .taken_over = taken_over});
}

TEST(FollowCorridor, PlansAlongTheMiddle) {
  FollowCorridor behavior(0, {});
  const Walls walls = EndOpenToTheLeft(0.3);  // its middle is 0.2 m to the right of the plan's origin
  const Intent intent = Decide(behavior, walls, walls.T_map_plan());
  EXPECT_EQ(intent.activity, Activity::kFollowsCorridor);
  EXPECT_EQ(intent.direction, Direction::kForwards);
  EXPECT_EQ(intent.speed_m_s, FollowCorridorConfig{}.speed_m_s);
  EXPECT_FALSE(intent.done);
  ASSERT_GT(intent.path_map.size(), 50u);
  for (const Eigen::Vector2d& p : intent.path_map) {
    const Eigen::Vector3d p_plan = walls.T_map_plan().inverse() * Eigen::Vector3d(p.x(), p.y(), 0.0);
    EXPECT_NEAR(p_plan.y(), -0.2, 0.1);
  }
}

TEST(FollowCorridor, PlansAQuarterCircleIntoTheOpenSide) {
  FollowCorridor behavior(0, {});
  const Walls walls = EndOpenToTheLeft(0.0);
  const Pose T_map_base = FromXyYaw(1.8, -0.2, 0.0);  // the end wall is 2.2 m ahead
  const Intent intent = Decide(behavior, walls, T_map_base);
  EXPECT_EQ(intent.activity, Activity::kTurnsLeft);
  EXPECT_EQ(intent.speed_m_s, FollowCorridorConfig{}.turn_speed_m_s);
  // Along the middle of the next corridor, 2 m wide as well: a metre before the end wall.
  EXPECT_NEAR(intent.path_map.back().x(), 3.0, 0.1);
  EXPECT_GT(intent.path_map.back().y(), 3.0);
  for (std::size_t i = 1; i < intent.path_map.size(); ++i)
    EXPECT_LT((intent.path_map[i] - intent.path_map[i - 1]).norm(), 0.1);
}

TEST(FollowCorridor, KeepsThePlanOfATurnUntilTheCarHasTurned) {
  FollowCorridor behavior(0, {});
  const Walls walls = EndOpenToTheLeft(0.0);
  const auto plan = Decide(behavior, walls, FromXyYaw(1.8, -0.2, 0.0)).path_map;
  EXPECT_EQ(Decide(behavior, walls, FromXyYaw(2.6, 0.2, 0.8)).path_map, plan);
  EXPECT_EQ(Decide(behavior, walls, FromXyYaw(3.0, 0.8, 0.5 * pi - 0.2)).activity, Activity::kTurnsLeft);
  EXPECT_EQ(Decide(behavior, walls, FromXyYaw(3.0, 0.9, 0.5 * pi - 0.1)).activity, Activity::kFollowsCorridor);
}

TEST(FollowCorridor, ForgetsThePlanOfATurnWhenSomebodyElseHasDriven) {
  FollowCorridor behavior(0, {});
  const Walls walls = EndOpenToTheLeft(0.0);
  EXPECT_EQ(Decide(behavior, walls, FromXyYaw(1.8, -0.2, 0.0)).activity, Activity::kTurnsLeft);
  // Brought back to before the corner, it follows the corridor again.
  EXPECT_EQ(Decide(behavior, walls, FromXyYaw(0.0, -0.2, 0.0), true).activity, Activity::kFollowsCorridor);
}

TEST(FollowCorridor, PlansNoTurnInADeadEnd) {
  FollowCorridor behavior(0, {});
  EXPECT_EQ(Decide(behavior, DeadEnd(0.0), FromXyYaw(2.5, 0.0, 0.0)).activity, Activity::kFollowsCorridor);
}

// The first frame at which the task is done, on a circle of 5 m radius to one side that begins along x.
int DoneAt(int laps, double side, int steps_per_lap, int steps) {
  FollowCorridor behavior(laps, {});
  const Walls walls(0.0);
  for (int i = 0; i <= steps; ++i) {
    const double angle = 2.0 * pi * i / steps_per_lap;
    const Pose T = FromXyYaw(5.0 * std::sin(angle), side * 5.0 * (1.0 - std::cos(angle)), WrapPi(side * angle));
    if (Decide(behavior, walls, T).done) return i;
  }
  return -1;
}

TEST(FollowCorridor, IsDoneAfterItsLapsAndTheOverlap) {
  // A step is 0.0785 m: nine of them are the first to be 0.7 m beyond the start line.
  EXPECT_EQ(DoneAt(1, 1.0, 400, 900), 400 + 9);
  EXPECT_EQ(DoneAt(1, -1.0, 400, 900), 400 + 9);
  EXPECT_EQ(DoneAt(2, 1.0, 400, 900), 800 + 9);
  EXPECT_EQ(DoneAt(0, 1.0, 400, 900), -1) << "endless";
}

}  // namespace
}  // namespace merlin
