#include "autonomy/pilot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "slam/slam.h"
#include "tests/autonomy/car.h"
#include "tests/autonomy/drive_in_walls.h"

namespace merlin {
namespace {

using std::numbers::pi;
using Activities = std::vector<Activity>;

// A corridor along x, 2 m wide, its middle at y = 0.
Walls StraightCorridor() {
  Walls walls(0.0);
  walls.Add(-3.0, 1.0, 9.0, 1.0);
  walls.Add(-3.0, -1.0, 9.0, -1.0);
  return walls;
}

// A wall of points this far ahead of the base, as wide as the car.
std::vector<Point> BlockAhead(double x_m) {
  std::vector<Point> points;
  for (int i = 0; i < 20; ++i)
    points.push_back({.position = {static_cast<float>(x_m), 0.01f * i - 0.1f, 0.3f}, .sigma_m = 0.01f});
  return points;
}

void ExpectStands(const Decision& decision, Activity activity) {
  EXPECT_EQ(decision.command.speed_m_s, 0.0);
  EXPECT_EQ(decision.activity, activity) << decision.doing;
  EXPECT_EQ(decision.doing, Sentence(activity));
  EXPECT_GT(decision.command.valid_for, Duration(0));
}

TEST(Pilot, SteersBackTowardsTheMiddle) {
  for (const double offset_m : {-0.3, 0.3}) {
    DriveInWalls drive(StraightCorridor());
    drive.car.y_m = offset_m;
    Pilot pilot(Car(), Task{}, {});
    const Decision decision = pilot.Decide(drive.Now());
    EXPECT_DOUBLE_EQ(decision.command.speed_m_s, FollowCorridorConfig{}.speed_m_s);
    EXPECT_GT(decision.command.steering_rad * -offset_m, 0.01) << offset_m;
    EXPECT_LE(std::abs(decision.command.steering_rad), Car().steering_max_rad);
    EXPECT_GT(decision.command.valid_for, Duration(0));
    EXPECT_EQ(drive.Drive(pilot, 160), Activities{Activity::kFollowsCorridor});
    EXPECT_NEAR(drive.car.y_m, 0.0, 0.05);
    EXPECT_NEAR(drive.car.x_m, 4.0, 0.1);
  }
}

TEST(Pilot, LeavesTheSteeringOffsetToTheLoop) {
  CarDescription car = Car();
  car.steering_offset_rad = 0.1;
  DriveInWalls drive(StraightCorridor());
  Pilot pilot(car, Task{}, {});
  EXPECT_NEAR(pilot.Decide(drive.Now()).command.steering_rad, 0.0, 0.02) << "the angle of the wheels";
}

TEST(Pilot, WaitsForAPose) {
  DriveInWalls drive(StraightCorridor());
  Pilot pilot(Car(), Task{}, {});
  Situation situation = drive.Now();
  situation.T_map_base.reset();
  ExpectStands(pilot.Decide(situation), Activity::kWaitsForHeading);
}

TEST(Pilot, StandsWhileItIsLostAndDrivesOnWhenAFrameFits) {
  DriveInWalls drive(StraightCorridor());
  Pilot pilot(Car(), Task{}, {.lost_frames_max = 20});
  EXPECT_GT(pilot.Decide(drive.Now(20)).command.speed_m_s, 0.0);
  ExpectStands(pilot.Decide(drive.Now(21)), Activity::kIsLost);
  ExpectStands(pilot.Decide(drive.Now(1000)), Activity::kIsLost);
  const Decision found = pilot.Decide(drive.Now(0));
  EXPECT_GT(found.command.speed_m_s, 0.0);
  EXPECT_EQ(found.activity, Activity::kFollowsCorridor);
}

TEST(Pilot, StandsBeforeAnObstacle) {
  DriveInWalls drive(StraightCorridor());
  Pilot pilot(Car(), Task{}, {});
  Situation situation = drive.Now();
  Observation blocked = situation.observation;
  blocked.points_base = BlockAhead(0.8);
  ExpectStands(pilot.Decide({.observation = blocked,
                             .T_map_base = situation.T_map_base,
                             .local_map = situation.local_map,
                             .grid = situation.grid}),
               Activity::kWaitsForObstacle);
}

TEST(Pilot, LooksForObstaclesWhereItWillDriveNotWhereItWantsToBe) {
  // Half a metre left of the middle, with a box right before the bumper: beside the middle line, but on the arc to it.
  DriveInWalls drive(StraightCorridor());
  drive.car.y_m = 0.5;
  Pilot pilot(Car(), Task{}, {});
  Situation situation = drive.Now();
  Observation blocked = situation.observation;
  blocked.points_base = BlockAhead(0.8);
  ExpectStands(pilot.Decide({.observation = blocked,
                             .T_map_base = situation.T_map_base,
                             .local_map = situation.local_map,
                             .grid = situation.grid}),
               Activity::kWaitsForObstacle);
}

// A bend: the corridor goes on to one side, 2 m wide as well. side: +1 left, -1 right.
Walls Bend(double side) {
  Walls walls(0.0);
  walls.Add(-2.0, side * 1.0, 3.0, side * 1.0);
  walls.Add(-2.0, side * -1.0, 5.0, side * -1.0);
  walls.Add(5.0, side * -1.0, 5.0, side * 9.0);
  walls.Add(3.0, side * 1.0, 3.0, side * 9.0);
  return walls;
}

TEST(Pilot, TurnsAroundACornerToEitherSide) {
  for (const double side : {1.0, -1.0}) {
    DriveInWalls drive(Bend(side));
    Pilot pilot(Car(), Task{}, {});
    EXPECT_EQ(drive.Drive(pilot, 300),
              (Activities{Activity::kFollowsCorridor, side > 0.0 ? Activity::kTurnsLeft : Activity::kTurnsRight,
                          Activity::kFollowsCorridor}));
    EXPECT_NEAR(drive.car.yaw_rad, side * 0.5 * pi, 0.05);
    EXPECT_NEAR(drive.car.x_m, 4.0, 0.05) << "in the middle of the next corridor";
    EXPECT_GT(side * drive.car.y_m, 1.5);
  }
}

TEST(Pilot, StopsBeforeTheWallOfADeadEnd) {
  DriveInWalls drive(DeadEnd(0.0));  // its wall is at x = 4, the bumper 0.45 m ahead of the base
  Pilot pilot(Car(), Task{}, {});
  EXPECT_EQ(drive.Drive(pilot, 240), (Activities{Activity::kFollowsCorridor, Activity::kWaitsForObstacle}));
  const double gap_m = 4.0 - 0.45 - drive.car.x_m;
  EXPECT_GE(gap_m, AvoidConfig{}.stop_gap_m - 0.05);
  EXPECT_LE(gap_m, AvoidConfig{}.stop_gap_m + 0.05);
}

TEST(Pilot, StandsOnTheTurntableUntilItHasTurnedEvenIfItIsLost) {
  DriveInWalls drive(StraightCorridor());
  Pilot pilot(Car(), Task{.behavior = "turn_on_turntable", .angle_deg = -180.0}, {});
  for (int i = 0; i <= 20; ++i) {
    drive.car.yaw_rad = WrapPi(-pi * i / 20);
    const Decision decision = pilot.Decide(drive.Now(i < 15 ? 100 : 0));
    ExpectStands(decision, i < 20 ? Activity::kTurnsOnTurntable : Activity::kIsDone);
    EXPECT_EQ(decision.done, i == 20);
    EXPECT_DOUBLE_EQ(*decision.turntable_rad, -pi);
  }
}

TEST(Pilot, StandsWhenTheTaskIsDone) {
  DriveInWalls drive(StraightCorridor());
  Pilot pilot(Car(), [](const Situation&) { return Intent{.speed_m_s = 0.5, .done = true}; }, {});
  const Decision decision = pilot.Decide(drive.Now());
  EXPECT_TRUE(decision.done);
  EXPECT_EQ(decision.command.speed_m_s, 0.0);
}

TEST(Pilot, HaltsAtTheEndOfThePath) {
  DriveInWalls drive(StraightCorridor());
  const Behavior two_metres = [](const Situation&) {
    Intent intent{.speed_m_s = 0.5, .activity = Activity::kFollowsCorridor};
    for (int i = 0; i <= 40; ++i) intent.path_map.emplace_back(0.05 * i, 0.0);
    return intent;
  };
  Pilot pilot(Car(), two_metres, {});
  EXPECT_EQ(drive.Drive(pilot, 200), Activities{Activity::kFollowsCorridor});
  EXPECT_NEAR(drive.car.x_m, 2.0, 0.03);
  EXPECT_EQ(drive.decision.command.speed_m_s, 0.0);
}

TEST(Pilot, HoldsTheSteeringOfAnIntentWithoutAPath) {
  DriveInWalls drive(StraightCorridor());
  Pilot pilot(Car(), [](const Situation&) { return Intent{.steering_rad = 0.2, .speed_m_s = 0.3}; }, {});
  const Decision decision = pilot.Decide(drive.Now());
  EXPECT_EQ(decision.command.steering_rad, 0.2);
  EXPECT_EQ(decision.command.speed_m_s, 0.3);
}

}  // namespace
}  // namespace merlin
