#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "slam/loop/loop_closer.h"

namespace merlin {
namespace {

// Walls of a corridor along x, 2 m wide, with pillars where asked for, 8 m of it from x0 on; frame of the map.
std::vector<Eigen::Vector3d> Corridor(double x0, bool pillars) {
  std::vector<Eigen::Vector3d> points;
  for (double z = 0.05; z < 1.2; z += 0.05) {
    for (double x = 0.0; x < 8.0; x += 0.05) points.emplace_back(x0 + x, 1.0, z), points.emplace_back(x0 + x, -1.0, z);
    for (const double x : {1.5, 3.5, 5.0})
      for (double y = 0.0; y < 0.7 && pillars; y += 0.05)
        points.emplace_back(x0 + x, 1.0 - y, z), points.emplace_back(x0 + x, y - 1.0, z);
  }
  for (double x = 0.0; x < 8.0; x += 0.1)
    for (double y = -1.0; y <= 1.0; y += 0.1) points.emplace_back(x0 + x, y, 0.0);
  return points;
}

std::vector<Point> SeenFrom(const std::vector<Eigen::Vector3d>& world, const Pose& T_world_base) {
  std::vector<Point> points;
  const Pose T_base_world = T_world_base.inverse();
  for (const Eigen::Vector3d& p : world) {
    const Eigen::Vector3d p_base = T_base_world * p;
    if (p_base.x() < 0.5 || p_base.x() > 4.5) continue;
    points.push_back({.position = p_base.cast<float>(), .sigma_m = 0.01f});
  }
  return points;
}

Keyframe At(const Pose& T_map_base, double path_m, const std::vector<Eigen::Vector3d>& world) {
  Keyframe keyframe;
  keyframe.T_map_base = T_map_base;
  keyframe.path_m = path_m;
  keyframe.points_base = SeenFrom(world, T_map_base);
  return keyframe;
}

std::vector<Keyframe> FirstVisit(const std::vector<Eigen::Vector3d>& world) {
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < 10; ++i) keyframes.push_back(At(FromXyYaw(0.1 * i, 0.0, 0.0), 0.1 * i, world));
  return keyframes;
}

constexpr double kLater_m = 50.0;

TEST(FindLoop, RecognisesThePlaceThirtyCentimetresAndOneDegreeOff) {
  const auto world = Corridor(0.0, true);
  const auto keyframes = FirstVisit(world);
  const Pose truth = FromXyYaw(0.4, 0.05, 0.01), believed = FromXyYaw(0.55, -0.2, 0.03);
  const auto loop = FindLoop(keyframes, SeenFrom(world, truth), believed, kLater_m, {});
  ASSERT_TRUE(loop);
  EXPECT_LT((loop->T_map_base.translation() - truth.translation()).norm(), 0.02);
  EXPECT_NEAR(Yaw(loop->T_map_base), 0.01, 0.004);
  EXPECT_GT(loop->overlap, 0.5);
}

TEST(FindLoop, FindsNoneSoonAfterNorElsewhereNorTheOtherWayNorInAnotherShape) {
  const auto world = Corridor(0.0, true);
  const auto keyframes = FirstVisit(world);
  const Pose here = FromXyYaw(0.4, 0.0, 0.0);
  const auto points = SeenFrom(world, here);
  ASSERT_TRUE(FindLoop(keyframes, points, here, kLater_m, {}));
  EXPECT_FALSE(FindLoop(keyframes, points, here, 5.0, {})) << "soon after";
  EXPECT_FALSE(FindLoop(keyframes, points, FromXyYaw(10.0, 0.0, 0.0), kLater_m, {})) << "elsewhere";
  EXPECT_FALSE(FindLoop(keyframes, points, FromXyYaw(0.4, 0.0, std::numbers::pi), kLater_m, {})) << "the other way";
  std::vector<Point> slanted = points;
  for (Point& point : slanted) point.position.y() *= 1.25f;
  EXPECT_FALSE(FindLoop(keyframes, slanted, here, kLater_m, {})) << "another shape";
  EXPECT_FALSE(FindLoop(keyframes, {}, here, kLater_m, {})) << "nothing seen";
  EXPECT_FALSE(FindLoop({}, points, here, kLater_m, {})) << "no key frames";
}

TEST(FindLoop, FindsNoneInABareCorridorWhichDoesNotTellWhereAlongIt) {
  const auto world = Corridor(0.0, false);
  EXPECT_FALSE(
      FindLoop(FirstVisit(world), SeenFrom(world, FromXyYaw(0.4, 0.0, 0.0)), FromXyYaw(0.5, 0.0, 0.0), kLater_m, {}));
}

// A square of 10 m edges driven once with odometry that drifts evenly one way in the room.
struct Square {
  explicit Square(const Eigen::Vector3d& drift_m) {
    const auto world = Corridor(0.0, true);
    Pose truth = Pose::Identity();
    Pose believed = truth, previous_believed = believed;
    for (int i = 0; i <= 410; ++i) {
      if (i > 0) {
        const Pose step = FromXyYaw(0.1, 0.0, i % 100 == 0 ? 0.5 * std::numbers::pi : 0.0);
        truth = truth * step;
        believed = believed * step;
        believed.translation() += drift_m / 410.0;
      }
      keyframes.push_back(At(believed, 0.1 * i, {}));
      if (i < 20 || i > 395) keyframes.back().points_base = SeenFrom(world, truth);  // else it is far from the corridor
      keyframes.back().T_previous_base = i == 0 ? Pose::Identity() : previous_believed.inverse() * believed;
      keyframes.back().yaw_rad = Yaw(truth);
      truths.push_back(truth);
      previous_believed = believed;
    }
  }
  std::vector<Keyframe> keyframes;
  std::vector<Pose> truths;
};

double WorstError_m(const std::vector<Pose>& poses, const std::vector<Pose>& truths) {
  double worst_m = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    worst_m = std::max(worst_m, (poses[i].translation() - truths[i].translation()).norm());
  return worst_m;
}

std::vector<Pose> PosesOf(const std::vector<Keyframe>& keyframes) {
  std::vector<Pose> poses;
  for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.T_map_base);
  return poses;
}

TEST(LoopCloser, ClosesTheSquareAfterTwoSearchesThatAgree) {
  const Square square({0.25, -0.2, 0.0});
  ASSERT_GT(WorstError_m(PosesOf(square.keyframes), square.truths), 0.25);
  LoopCloser closer({});
  const auto search = [&](std::size_t newest) {
    const std::span<const Keyframe> until = std::span(square.keyframes).first(newest + 1);
    const Keyframe& now = until.back();
    return closer.Search(until, now.points_base, now.T_map_base, now.path_m);
  };
  EXPECT_FALSE(search(200)) << "half way round";
  EXPECT_FALSE(search(404)) << "once";
  EXPECT_EQ(closer.loops(), 0);
  const auto solved = search(408);
  ASSERT_TRUE(solved) << "twice";
  EXPECT_EQ(closer.loops(), 1);
  EXPECT_EQ(closer.SinceLoop_m(square.keyframes[408].path_m), 0.0);
  EXPECT_LT(((*solved)[408].translation() - square.truths[408].translation()).norm(), 0.03);
  EXPECT_LT(WorstError_m(*solved, square.truths), 0.04);
  EXPECT_EQ(solved->front().matrix(), square.keyframes.front().T_map_base.matrix());
}

TEST(LoopCloser, RejectsALoopThatOdometryRulesOut) {
  const Square square({1.2, -0.3, 0.0});
  LoopCloser closer({.reach_m = 3.0, .start_sigma_m = 2.0, .agreeing_min = 1, .chi2_max = 21.1});
  const Keyframe& last = square.keyframes.back();
  EXPECT_FALSE(closer.Search(square.keyframes, last.points_base, last.T_map_base, last.path_m));
  EXPECT_EQ(closer.loops(), 0);
}

// What registration reports of key frame `to` where key frame `from` recognises it: the truth, but for an error.
std::optional<std::vector<Pose>> CloseBetween(LoopCloser& closer, const Square& square, std::size_t from,
                                              std::size_t to, const Pose& error) {
  const Keyframe& former = square.keyframes[from];
  const Loop loop{.former = from,
                  .T_map_base = former.T_map_base * square.truths[from].inverse() * square.truths[to] * error,
                  .covariance = 1e-4 * Matrix6d::Identity()};  // 1 cm and 0.01 rad
  return closer.Close(square.keyframes, loop, square.keyframes[to].T_map_base, square.keyframes[to].path_m);
}

TEST(LoopCloser, TakesAWrongLoopOutAgainThatOtherLoopsContradict) {
  const Square square({0.05, -0.04, 0.0});
  Square bent = square;
  LoopCloser closer({}), deceived({});
  const auto wrong = CloseBetween(deceived, bent, 100, 300, FromXyYaw(0.12, 0.1, 0.0));
  ASSERT_TRUE(wrong) << "alone it looks right: 0.16 m in 20 m, three times the error of odometry";
  EXPECT_GT(WorstError_m(*wrong, square.truths), 0.1);
  for (std::size_t i = 0; i < wrong->size(); ++i) bent.keyframes[i].T_map_base = (*wrong)[i];
  for (const std::size_t from : {0, 104}) {
    const std::size_t to = from == 0 ? 400 : 304;
    const auto poses = CloseBetween(closer, square, from, to, Pose::Identity());
    const auto poses_deceived = CloseBetween(deceived, bent, from, to, Pose::Identity());
    ASSERT_TRUE(poses && poses_deceived);
    for (std::size_t i = 0; i < poses->size(); ++i) bent.keyframes[i].T_map_base = (*poses_deceived)[i];
    if (from == 0) continue;
    EXPECT_LT(WorstError_m(*poses_deceived, *poses), 1e-4) << "the same map as without the wrong loop";
  }
  EXPECT_EQ(closer.loops(), 2);
  EXPECT_EQ(deceived.loops(), 2);
}

TEST(LoopCloser, RefusesAWrongLoopWhereTwoRightOnesAreKnown) {
  const Square square({0.05, -0.04, 0.0});
  LoopCloser closer({});
  ASSERT_TRUE(CloseBetween(closer, square, 0, 400, Pose::Identity()));
  ASSERT_TRUE(CloseBetween(closer, square, 104, 304, Pose::Identity()));
  EXPECT_FALSE(CloseBetween(closer, square, 100, 300, FromXyYaw(0.12, 0.1, 0.0)));
  EXPECT_EQ(closer.loops(), 2);
}

// One sigma of the yaw after the fourth corner: 0.02 rad / sqrt(number of headings) with a compass, without one at least
// 0.025 rad * sqrt(pi / 2) = 0.031 rad.
TEST(LoopCloser, AllowsTheYawToDriftMoreWithoutACompass) {
  Square square(Eigen::Vector3d::Zero());
  LoopCloser with({});
  EXPECT_FALSE(CloseBetween(with, square, 0, 405, FromXyYaw(0.0, 0.0, 0.08)));
  for (Keyframe& keyframe : square.keyframes) keyframe.yaw_rad.reset();
  LoopCloser without({});
  EXPECT_TRUE(CloseBetween(without, square, 0, 405, FromXyYaw(0.0, 0.0, 0.08)));
  EXPECT_FALSE(CloseBetween(without, square, 0, 405, FromXyYaw(0.0, 0.0, 0.6))) << "not that much";
}

// The second half of the square is another run, of which only its place in the first one is known. Odometry errs by 0.08 m
// in 40 m.
TEST(LoopCloser, JudgesLoopsBetweenTwoRunsByThePlaceThatJoinedThem) {
  Square square({0.05, -0.04, 0.0});
  square.keyframes[200].first_of_run = true;
  const Loop place{.former = 199,
                   .T_map_base = square.keyframes[199].T_map_base * square.truths[199].inverse() * square.truths[200],
                   .covariance = 1e-4 * Matrix6d::Identity()};
  LoopCloser closer({});
  closer.Join({}, 200, std::span(square.keyframes).first(201), place, square.keyframes[200].path_m);
  EXPECT_FALSE(CloseBetween(closer, square, 0, 400, FromXyYaw(3.0, 0.0, 0.0)));
  const auto poses = CloseBetween(closer, square, 0, 400, Pose::Identity());
  ASSERT_TRUE(poses);
  EXPECT_LT(WorstError_m(*poses, square.truths), 0.04);
  EXPECT_EQ(closer.loops(), 1) << "the place is none";
  ASSERT_EQ(closer.edges().size(), 2u);
  EXPECT_FALSE(closer.edges().front().robust) << "nothing else holds the two runs together";
}

TEST(LoopCloser, LeavesAMapWithoutDriftAsItIs) {
  const Square square(Eigen::Vector3d::Zero());
  LoopCloser closer({.agreeing_min = 1});
  const Keyframe& last = square.keyframes.back();
  const auto solved = closer.Search(square.keyframes, last.points_base, last.T_map_base, last.path_m);
  ASSERT_TRUE(solved);
  EXPECT_LT(WorstError_m(*solved, square.truths), 0.01);
}

TEST(LoopCloser, SearchesOnlyIfSwitchedOnAndSomeDistanceAfterTheLastSearch) {
  EXPECT_FALSE(LoopCloser({.enabled = false}).IsDue(100.0));
  LoopCloser closer({.every_m = 0.5});
  EXPECT_TRUE(closer.IsDue(0.5));
  closer.Search({}, {}, Pose::Identity(), 1.0);
  EXPECT_FALSE(closer.IsDue(1.4));
  EXPECT_TRUE(closer.IsDue(1.5));
  EXPECT_GT(closer.SinceLoop_m(1.5), 1e300) << "none was ever found";
}

}  // namespace
}  // namespace merlin
