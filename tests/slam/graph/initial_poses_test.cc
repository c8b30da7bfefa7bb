#include "slam/graph/initial_poses.h"

#include <gtest/gtest.h>

#include "slam/graph/objective.h"
#include "tests/slam/graph/random_graph.h"

namespace merlin {
namespace {

void ExpectSame(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT((a[i].matrix() - b[i].matrix()).norm(), 1e-9) << i;
}

TEST(InitialPoses, AreExactForEdgesWithoutError) {
  for (const bool planar : {false, true}) {
    PoseGraph graph = RandomGraphs(1).Walk(25, 0.0, planar);
    const std::vector<Pose> truth = graph.poses;
    for (const std::vector<std::size_t>& fixed : {std::vector<std::size_t>{}, {7}, {2, 11}}) {
      graph.fixed = fixed;
      for (std::size_t i = 0; i < truth.size(); ++i)
        if (std::ranges::find(fixed, i) == fixed.end() && (i > 0 || !fixed.empty())) graph.poses[i] = Pose::Identity();
      ExpectSame(ChainedPoses(graph), truth);
      const auto chordal = ChordalPoses(graph);
      ASSERT_TRUE(chordal);
      ExpectSame(*chordal, truth);
      graph.poses = truth;
    }
  }
}

TEST(InitialPoses, ChainFollowsOdometryAndNotLoops) {
  PoseGraph graph{.poses = std::vector<Pose>(4, Pose::Identity()), .edges = {}, .fixed = {}, .planar = true};
  graph.edges.push_back({.from = 0, .to = 3, .T_from_to = FromXyYaw(99.0, 0.0, 0.0)});
  graph.edges.push_back({.from = 0, .to = 2, .T_from_to = FromXyYaw(99.0, 0.0, 0.0)});
  for (std::size_t i = 3; i > 0; --i)
    graph.edges.push_back({.from = i, .to = i - 1, .T_from_to = FromXyYaw(-1.0, 0.0, 0.0)});
  const std::vector<Pose> poses = ChainedPoses(graph);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(poses[i].translation().x(), i, 1e-15);
}

// Closing a turn that is 0.09 rad too long: each of nine equal edges takes 0.01 rad of it, as to first order the
// relaxed rotations do exactly by symmetry; far from the 0.08 that the chain leaves to the last.
TEST(InitialPoses, ChordalSharesTheMisfit) {
  PoseGraph graph{.poses = std::vector<Pose>(9, Pose::Identity()), .edges = {}, .fixed = {}, .planar = true};
  const double step_rad = 2.0 * std::numbers::pi / 9 + 0.01;
  for (std::size_t i = 0; i < 9; ++i)
    graph.edges.push_back({.from = i, .to = (i + 1) % 9, .T_from_to = FromXyYaw(1.0, 0.0, step_rad)});
  const auto poses = ChordalPoses(graph);
  ASSERT_TRUE(poses);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(WrapPi(Yaw((*poses)[(i + 1) % 9]) - Yaw((*poses)[i])), step_rad - 0.01, 2e-3) << i;
  graph.poses = *poses;
  const double chordal = Evaluate(graph, Objective::kA);
  graph.poses = ChainedPoses(graph);
  EXPECT_LT(chordal, 0.5 * Evaluate(graph, Objective::kA));
}

TEST(InitialPoses, AreNoneIfAPoseIsNotConnected) {
  PoseGraph graph = RandomGraphs(2).Walk(5, 0.0, false);
  graph.poses.push_back(Exp(Vector6d::Ones()));
  EXPECT_FALSE(ChordalPoses(graph));
  EXPECT_EQ(ChainedPoses(graph).back().matrix(), graph.poses.back().matrix());
  graph.edges.push_back({.from = 0, .to = 5, .information = Matrix6d::Zero()});
  EXPECT_FALSE(ChordalPoses(graph));  // joined, but without weight
}

TEST(InitialPoses, OfOnePoseAreThatPose) {
  const PoseGraph graph{.poses = {Exp(Vector6d::Ones())}, .edges = {}, .fixed = {}, .planar = false};
  EXPECT_EQ(ChainedPoses(graph)[0].matrix(), graph.poses[0].matrix());
  EXPECT_EQ((*ChordalPoses(graph))[0].matrix(), graph.poses[0].matrix());
  EXPECT_TRUE(ChordalPoses({}).value().empty());
}

}  // namespace
}  // namespace merlin
