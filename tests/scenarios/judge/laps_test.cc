#include "scenarios/judge/laps.h"

#include <gtest/gtest.h>

#include <algorithm>

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

TEST(CountLaps, WantsTheWayBackToTheStart) {
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, {-1.01, -7}}), kOutline), 0);
  EXPECT_EQ(CountLaps(Along({kStart, kB, kC, kD, kA, {-0.99, -7}}), kOutline), 1);
}

TEST(CountLaps, DoesNotCountWhenACornerIsLeftOut) {
  EXPECT_EQ(CountLaps(Along({kStart, kB, kD, kA, kStart}), kOutline), 0);  // across, past no third corner
  EXPECT_EQ(CountLaps(Along({kStart, kB, {9, 5}, {-9, 5.4}, kA, kStart}), kOutline),
            0);  // two corners cut by more than 2.5 m
}

TEST(CountLaps, CountsACornerWithinItsReachOnly) {
  // The corner (10, -8) passed diagonally below it: at 2.4 m, then at 2.6 m.
  for (const auto& [reach_m, laps] : {std::pair(2.4, 1), std::pair(2.6, 0)}) {
    const double cut = reach_m * std::sqrt(2.0);
    EXPECT_EQ(CountLaps(Along({kStart, {10 - cut, -8}, {10, -8 + cut}, kC, kD, kA, kStart}), kOutline), laps)
        << reach_m;
  }
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
