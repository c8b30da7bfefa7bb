#include "scenarios/judge/laps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

const Outline kOutline{{-10, -8}, {10, -8}, {10, 8}, {-10, 8}};

// A path from point to point in steps of at most 0.2 m.
Trajectory Along(const std::vector<Eigen::Vector2d>& points) {
  Trajectory path;
  const auto add = [&path](const Eigen::Vector2d& p) {
    path.push_back({Time(static_cast<std::int64_t>(path.size())), FromXyYaw(p.x(), p.y(), 0)});
  };
  add(points.front());
  for (std::size_t i = 1; i < points.size(); ++i) {
    const int steps = static_cast<int>((points[i] - points[i - 1]).norm() / 0.2) + 1;
    for (int k = 1; k <= steps; ++k) add(points[i - 1] + (points[i] - points[i - 1]) * k / steps);
  }
  return path;
}

// The middle of a 2 m corridor: 1.41 m from the outline's corners.
const Eigen::Vector2d kStart(0, -7), kA(-9, -7), kB(9, -7), kC(9, 7), kD(-9, 7);

TEST(CountLaps, CountsOnceRoundInEitherDirection) {
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, kStart}), kOutline), 1);
  EXPECT_EQ(CountLaps(Along({kStart, kA, kD, kC, kB, kStart}), kOutline), 1);
}

TEST(CountLaps, CountsEveryRound) {
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, kB, kC, kD, kA, kB}), kOutline), 2);
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, kStart, kA, kD, kC, kB, kStart}), kOutline), 2);
}

TEST(CountLaps, CountsWithAStartBesideACorner) {
  EXPECT_EQ(CountLaps(Along({kA, kB, kC, kD, kA}), kOutline), 1);
  EXPECT_EQ(CountLaps(Along({kA, kD, kC, kB, kA, kD, kC, kB, kA}), kOutline), 2);
}

TEST(CountLaps, WantsTheStartingLineCrossedAgain) {
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, {-0.01, -7}}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, {0.01, -7}}), kOutline), 1);
}

TEST(CountLaps, CountsAroundTheCentreOnly) {
  EXPECT_EQ(CountLaps(Along({kStart, kB, {9, 1}, {-9, 1}, kA, kStart}), kOutline), 1);  // half the room, and the centre
  EXPECT_EQ(CountLaps(Along({kStart, kB, {9, -1}, {-9, -1}, kA, kStart}), kOutline), 0);  // half the room without it
}

// Rectangle of these half sizes, from its lower middle, counter-clockwise.
std::vector<Eigen::Vector2d> HalfRectangle(double half_x_m, double half_y_m) {
  return {{0, -half_y_m},        {half_x_m, -half_y_m},  {half_x_m, half_y_m},
          {-half_x_m, half_y_m}, {-half_x_m, -half_y_m}, {0, -half_y_m}};
}

TEST(CountLaps, CountsInEveryLaneOfACorridorOfAnyWidth) {
  // 0.8, 2 and 5 m wide: in its middle, and 0.2 m from either wall. The start's lane is not the end's.
  for (const double width_m : {0.8, 2.0, 5.0})
    for (const double from_wall_m : {0.2, 0.5 * width_m, width_m - 0.2}) {
      auto points = HalfRectangle(10 - from_wall_m, 8 - from_wall_m);
      EXPECT_EQ(CountLaps(Along(points), kOutline), 1) << width_m << " " << from_wall_m;
      points.back().x() -= 0.05;
      EXPECT_EQ(CountLaps(Along(points), kOutline), 0) << width_m << " " << from_wall_m;
      points.back() = {0.05, -8 + 0.5 * width_m};
      EXPECT_EQ(CountLaps(Along(points), kOutline), 1) << width_m << " " << from_wall_m;
    }
}

TEST(CountLaps, CountsWhereTheLineStandsAcrossTheCorridorNotWhereItPointsAtTheCentre) {
  // From the middle of a 2 m corridor, 6 m beside the room's middle; the end in lanes 0.5 m to either side.
  for (const double lane_m : {-7.5, -6.5})
    for (const auto& [x, laps] : {std::pair(5.95, 0), std::pair(6.05, 1)})
      EXPECT_EQ(CountLaps(Along({{6, -7}, kB, kC, kD, {-9, lane_m}, {x, lane_m}}), kOutline), laps) << lane_m;
}

TEST(CountLaps, CountsCirclesByTheWholeTurn) {
  Trajectory path;
  for (int i = 0; i <= 80; ++i) {  // ten turns of a circle around the centre, eight points a turn
    const double angle_rad = 1.0 + i * M_PI / 4.0;
    path.push_back({Time(i), FromXyYaw(5 * std::cos(angle_rad), 5 * std::sin(angle_rad), 0)});
    EXPECT_EQ(CountLaps(path, kOutline), i / 8) << i;
  }
}

TEST(CountLaps, DoesNotCountJitterOnTheLine) {
  std::vector<Eigen::Vector2d> points{kStart};
  const auto jitter = [&points] {
    for (int i = 0; i < 20; ++i) points.emplace_back(i % 2 == 0 ? 0.03 : -0.03, -7);
  };
  jitter();
  EXPECT_EQ(CountLaps(Along(points), kOutline), 0);
  points.insert(points.end(), {kB, kC, kD, kA});
  jitter();
  EXPECT_EQ(CountLaps(Along(points), kOutline), 1);
  points.insert(points.end(), {kB, kC, kD, kA});
  jitter();
  EXPECT_EQ(CountLaps(Along(points), kOutline), 2);
}

TEST(CountLaps, TakesBackWhatIsDrivenBack) {
  EXPECT_EQ(CountLaps(Along({kStart, {-2, -7}, kB, kC, kD, kA, {-0.1, -7}}), kOutline), 0);  // 2 m back at first
  EXPECT_EQ(CountLaps(Along({kStart, {-2, -7}, kB, kC, kD, kA, {0.1, -7}}), kOutline), 1);
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kC, kD, kA, kD, kA, {0.1, -7}}), kOutline), 1);
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, {2, -7}, {-2, -7}, {2, -7}}), kOutline), 1);
}

TEST(CountLaps, CountsAFigureOfEightByItsLoopAroundTheCentre) {
  const Eigen::Vector2d left(-2, -7), crossing(-4, -2);  // one loop around the centre, one around a place beside it
  const std::vector<Eigen::Vector2d> around{kStart, kB, kC, {-4, 7}, crossing};
  std::vector<Eigen::Vector2d> eight = around;
  eight.insert(eight.end(), {{-4, -4}, {-8, -4}, {-8, -3}, crossing, left, kStart});
  EXPECT_EQ(CountLaps(Along(eight), kOutline), 1);
  // Both loops beside the centre, or the crossing on the centre: the path winds around nothing.
  EXPECT_EQ(CountLaps(Along({{-5, -3}, {-5, 3}, {5, -3}, {5, 3}, {-5, -3}}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({{-5, -3}, {-5, 3}, {-1, 0}, {-1, -3}, {-5, -3}}), kOutline), 0);
}

TEST(CountLaps, StartsAnewWhereThePathRunsOverTheCentre) {
  // There and back over it, to its left there and to its right back; then half round: no whole turn.
  for (const double beside_m : {0.0, 0.05, -0.05})
    EXPECT_EQ(CountLaps(Along({kStart, {beside_m, 0}, {0, 7}, {-beside_m, 0}, kStart, {0, -7.5}}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({kStart, {0, 7}, kD, kA, {1, -7}}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({kStart, {0, 7}, kC, kB, {-1, -7}}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({kStart, {0, 7}, kD, kA, kB, kC, kD, kA, {1, -7}}), kOutline), 1);
  EXPECT_EQ(CountLaps(Along({{0, 0}, {3, 0}, {0, 3}, {-3, 0}, {0, -3}, {3, 0}, {0, 3}, {-3, 0}, {0, -3}}), kOutline), 1)
      << "a start on the centre";
}

TEST(CountLaps, AsksTheCentreOfTheAreaWhereverTheRoomLies) {
  // A trapezium far from the origin, with clockwise corners, one of them repeated: the mean of its corners is not its
  // centroid.
  const Outline room{{1000, 500}, {1000, 500}, {1000, 510}, {1004, 510}, {1030, 500}};
  // Its centre by hand: a square part of 4 x 10 m and a triangle of 26 x 10 m.
  const Eigen::Vector2d centre((40 * 1002.0 + 130 * (1004 + 26 / 3.0)) / 170,
                               (40 * 505.0 + 130 * (500 + 10 / 3.0)) / 170);
  const auto around = [](const Eigen::Vector2d& c, double size_m) {
    std::vector<Eigen::Vector2d> points;
    for (const auto& [x, y] : {std::pair(0, -1), {1, -1}, {1, 1}, {-1, 1}, {-1, -1}, {0, -1}})
      points.emplace_back(c + size_m * Eigen::Vector2d(x, y));
    return points;
  };
  EXPECT_EQ(CountLaps(Along(around(centre, 0.3)), room), 1);
  for (const auto& [x, y] : {std::pair(0.5, 0.0), {-0.5, 0.0}, {0.0, 0.5}, {0.0, -0.5}})
    EXPECT_EQ(CountLaps(Along(around(centre + Eigen::Vector2d(x, y), 0.3)), room), 0) << x << " " << y;
}

TEST(CountLaps, DoesNotCountGoingThereAndBack) {
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kC, kB, kStart}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({kStart, kB, kStart, kA, kStart, kB, kStart}), kOutline), 0);
}

TEST(CountLaps, CountsAfterTurningRound) {
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kB, kStart, kA, kD, kC, kB, kStart}), kOutline), 1);
}

TEST(CountLaps, IsZeroForNothingToCount) {
  EXPECT_EQ(CountLaps({}, kOutline), 0);
  EXPECT_EQ(CountLaps(Trajectory(1000, {Time(0), FromXyYaw(0, -7, 0)}), kOutline), 0);   // standing
  EXPECT_EQ(CountLaps(Trajectory(1000, {Time(0), FromXyYaw(-9, -7, 0)}), kOutline), 0);  // standing at a corner
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, kStart}), {}), 0);                  // no outline
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, kStart}), {{0, 0}, {1, 0}}), 0);    // no area
}

TEST(CountLaps, PassesOverPositionsThatAreNotFinite) {
  Trajectory path = Along({kStart, kB, kC, kD, kA, kStart});
  path[path.size() / 2].T.translation().setConstant(std::nan(""));
  EXPECT_EQ(CountLaps(path, kOutline), 1);
}

}  // namespace
}  // namespace merlin
