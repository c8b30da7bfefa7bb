// The pilot drives backwards, in closed loop: a kinematic car on ground that an occupancy grid knows, or does not know.
#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/pilot.h"
#include "tests/autonomy/car.h"
#include "tests/autonomy/toy_car.h"

namespace merlin {
namespace {

constexpr double kRear_m = 0.45;  // from the base to the rear of the car
constexpr double kTick_s = 0.05;

// Asks to back along a path, as fast as allowed.
Behavior Backing(const std::vector<Eigen::Vector2d>& path_map) {
  return [path_map](const Situation&) {
    return Intent{
        .path_map = path_map, .direction = Direction::kBackwards, .speed_m_s = 2.0, .activity = Activity::kBacks};
  };
}

std::vector<Eigen::Vector2d> PathBack(double length_m) {
  std::vector<Eigen::Vector2d> path;
  for (int i = 0; i <= std::lround(length_m / 0.05); ++i) path.emplace_back(-0.05 * i, 0.0);
  return path;
}

struct End {
  ToyCar car;
  Decision decision;
  double fastest_m_s = 0.0;
};

// Drives for half a minute. Decisions of the pilot reach the wheels two frames late, as in the car.
End Back(const OccupancyGrid& grid, const Behavior& behavior, ToyCar car = {}) {
  Pilot pilot(Car(), behavior, {});
  const VoxelMap map({});
  Observation observation;
  End end{.car = car, .decision = {}};
  std::vector<DriveCommand> late(2);
  for (int i = 0; i < 600; ++i) {
    observation.stamp = FromSeconds(kTick_s * i);
    end.decision =
        pilot.Decide({.observation = observation, .T_map_base = end.car.T_map_base(), .local_map = map, .grid = grid});
    late.push_back(end.decision.command);
    end.car.Drive(late[late.size() - 3], kTick_s);
    end.fastest_m_s = std::max(end.fastest_m_s, std::abs(end.decision.command.speed_m_s));
    EXPECT_LE(end.decision.command.speed_m_s, 0.0);
  }
  return end;
}

TEST(Backing, BacksHalfAMetreOverKnownFreeGroundAndSlowly) {
  OccupancyGrid grid({});
  SeeFree(grid, -3.0, 1.0, -1.0, 1.0);
  const End end = Back(grid, Backing(PathBack(0.5)));
  EXPECT_NEAR(end.car.x_m, -0.5, 0.02);
  EXPECT_NEAR(end.car.y_m, 0.0, 0.001);
  EXPECT_EQ(end.decision.activity, Activity::kBacks);
  EXPECT_EQ(end.decision.command.speed_m_s, 0.0);
  EXPECT_DOUBLE_EQ(end.fastest_m_s, BackConfig{}.speed_max_m_s);
}

TEST(Backing, RefusesUnknownGround) {
  const End end = Back(OccupancyGrid({}), Backing(PathBack(2.0)));
  EXPECT_EQ(end.car.x_m, 0.0);
  EXPECT_EQ(end.fastest_m_s, 0.0);
  EXPECT_EQ(end.decision.activity, Activity::kWaitsForFreeGround);
  EXPECT_EQ(end.decision.doing, Sentence(Activity::kWaitsForFreeGround));
}

TEST(Backing, StopsBeforeTheGroundThatTheMapDoesNotKnow) {
  OccupancyGrid grid({});
  SeeFree(grid, -1.5, 1.0, -1.0, 1.0);
  const End end = Back(grid, Backing(PathBack(3.0)));
  EXPECT_GT(end.car.x_m - kRear_m, -1.5 + 0.05);
  EXPECT_LT(end.car.x_m - kRear_m, -1.5 + 0.3) << "it backs as far as it can";
  EXPECT_EQ(end.decision.activity, Activity::kWaitsForFreeGround);
}

TEST(Backing, RefusesGroundThatIsKnownTooNarrowly) {
  OccupancyGrid grid({});
  SeeFree(grid, -3.0, 1.0, -0.1, 1.0);  // the car needs 0.15 m to its right
  EXPECT_EQ(Back(grid, Backing(PathBack(2.0))).car.x_m, 0.0);
}

TEST(Backing, StopsAtLeastFiveCentimetresBeforeAWallBehindIt) {
  for (double wall_m = -1.3; wall_m > -1.4; wall_m -= 0.013) {  // at any place within a cell
    OccupancyGrid grid({});
    SeeFree(grid, -3.0, 1.0, -1.0, 1.0);
    for (double y = -0.975; y < 1.0; y += 0.05) SeeOccupied(grid, wall_m - 0.001, y);
    const End end = Back(grid, Backing(PathBack(2.0)));
    EXPECT_GE(end.car.x_m - kRear_m - wall_m, 0.05) << wall_m;
    EXPECT_LE(end.car.x_m - kRear_m - wall_m, 0.3) << wall_m << ": it backs as far as it can";
    EXPECT_EQ(end.decision.activity, Activity::kWaitsForFreeGround);
  }
}

TEST(Backing, FollowsAnArcBehindTheCar) {
  OccupancyGrid grid({});
  SeeFree(grid, -4.0, 2.0, -2.0, 4.0);
  std::vector<Eigen::Vector2d> arc;  // of 1.5 m radius, to the left behind the car
  for (double a = 0.0; a < 1.2; a += 0.03) arc.emplace_back(-1.5 * std::sin(a), 1.5 * (1.0 - std::cos(a)));
  const End end = Back(grid, Backing(arc));
  EXPECT_LT((Eigen::Vector2d(end.car.x_m, end.car.y_m) - arc.back()).norm(), 0.1);
  EXPECT_NEAR(end.car.yaw_rad, -1.2, 0.15) << "the car looks against the direction of the path";
}

TEST(Backing, ReturnsToALineFromBesideIt) {
  OccupancyGrid grid({});
  SeeFree(grid, -7.0, 2.0, -2.0, 2.0);
  const End end = Back(grid, Backing(PathBack(4.0)), {.y_m = 0.3});
  EXPECT_NEAR(end.car.x_m, -4.0, 0.05);
  EXPECT_NEAR(end.car.y_m, 0.0, 0.02);
}

TEST(Backing, NeedsNoPath) {
  OccupancyGrid grid({});
  SeeFree(grid, -1.5, 1.0, -1.0, 1.0);
  const End end = Back(grid, [](const Situation&) {
    return Intent{.direction = Direction::kBackwards, .speed_m_s = 0.1, .activity = Activity::kBacks};
  });
  EXPECT_GT(end.car.x_m - kRear_m, -1.5 + 0.05);
  EXPECT_LT(end.car.x_m, -0.6);
  EXPECT_DOUBLE_EQ(end.fastest_m_s, 0.1);
}

// Drives a circle to the left, which the map knows only by the car's own body, key frame by key frame. Gives the way back
// along the circle, and on beyond its start at the origin.
std::vector<Eigen::Vector2d> DriveUnseen(OccupancyGrid& grid, ToyCar& car) {
  constexpr double kSteering_rad = 0.08;  // tighter, and the gap behind the car would reach out of where it drove
  for (int i = 0; i < 40; ++i) {
    if (i % 2 == 0) grid.Cover(FootprintOf(Car()), car.T_map_base());
    car.Drive({.speed_m_s = 1.0, .steering_rad = kSteering_rad}, 0.05);
  }
  std::vector<Eigen::Vector2d> path;
  for (ToyCar back = car; path.size() < 60; back.Drive({.speed_m_s = -1.0, .steering_rad = kSteering_rad}, 0.05))
    path.emplace_back(back.x_m, back.y_m);
  return path;
}

TEST(Backing, BacksOverThePathThatItDroveAndNeverSaw) {
  OccupancyGrid grid({});
  ToyCar car;
  const std::vector<Eigen::Vector2d> path = DriveUnseen(grid, car);
  const End end = Back(grid, Backing(path), car);
  EXPECT_EQ(end.decision.activity, Activity::kWaitsForFreeGround);
  EXPECT_GE(end.car.x_m, 0.05) << "behind its start it knows nothing";
  EXPECT_LE(end.car.x_m, 0.35) << "it backs as far as it can";
  EXPECT_EQ(Back(OccupancyGrid({}), Backing(path), car).fastest_m_s, 0.0) << "without that knowledge";
}

TEST(Backing, StopsOnItsOwnPathBeforeWhatCameThereLater) {
  OccupancyGrid grid({});
  ToyCar car;
  const std::vector<Eigen::Vector2d> path = DriveUnseen(grid, car);
  const Eigen::Vector2d came = path[30];  // half a metre after the start
  SeeOccupied(grid, came.x(), came.y());
  const End end = Back(grid, Backing(path), car);
  EXPECT_EQ(end.decision.activity, Activity::kWaitsForFreeGround);
  const double behind_m = -(end.car.T_map_base().inverse() * Eigen::Vector3d(came.x(), came.y(), 0.0)).x();
  EXPECT_GE(behind_m - kRear_m, 0.05);
  EXPECT_LE(behind_m - kRear_m, 0.4) << "it backs as far as it can";
}

}  // namespace
}  // namespace merlin
