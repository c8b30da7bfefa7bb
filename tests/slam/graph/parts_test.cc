#include "slam/graph/parts.h"

#include <gtest/gtest.h>

#include "slam/graph/optimize.h"
#include "tests/slam/graph/random_graph.h"

namespace merlin {
namespace {

TEST(PartsOf, AJoinedGraphIsThatGraph) {
  RandomGraphs random(1);
  PoseGraph graph = random.Walk(20, 0.1, true);
  graph.fixed = {0, 3};
  const std::vector<GraphPart> parts = PartsOf(graph);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_TRUE(parts[0].graph.planar);
  EXPECT_EQ(parts[0].graph.fixed, graph.fixed);
  ASSERT_EQ(parts[0].graph.edges.size(), graph.edges.size());
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    EXPECT_EQ(parts[0].graph.edges[i].from, graph.edges[i].from);
    EXPECT_EQ(parts[0].graph.edges[i].to, graph.edges[i].to);
  }
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    EXPECT_EQ(parts[0].poses[i], i);
    EXPECT_EQ(parts[0].graph.poses[i].matrix(), graph.poses[i].matrix());
  }
  EXPECT_TRUE(PartsOf({}).empty());
}

// Poses 0 2 4 and 1 3 form chains, 5 is alone.
TEST(PartsOf, SharesOutPosesEdgesAndFixedOnes) {
  PoseGraph graph{.poses = std::vector<Pose>(6, Pose::Identity()), .fixed = {3, 4}};
  for (std::size_t i = 0; i < 6; ++i) graph.poses[i].translation().x() = static_cast<double>(i);
  for (const auto& [from, to] : {std::pair{4u, 2u}, std::pair{1u, 3u}, std::pair{2u, 0u}})
    graph.edges.push_back({.from = from, .to = to});
  const std::vector<GraphPart> parts = PartsOf(graph);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].poses, (std::vector<std::size_t>{0, 2, 4}));
  EXPECT_EQ(parts[1].poses, (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(parts[2].poses, (std::vector<std::size_t>{5}));
  EXPECT_EQ(parts[0].graph.fixed, std::vector<std::size_t>{2});
  EXPECT_EQ(parts[1].graph.fixed, std::vector<std::size_t>{1});
  EXPECT_TRUE(parts[2].graph.fixed.empty() && parts[2].graph.edges.empty());
  ASSERT_EQ(parts[0].graph.edges.size(), 2u);
  EXPECT_EQ(parts[0].graph.edges[0].from, 2u);
  EXPECT_EQ(parts[0].graph.edges[1].to, 0u);
  EXPECT_EQ(parts[1].graph.edges[0].to, 1u);

  PoseGraph copy{.poses = std::vector<Pose>(6, Pose::Identity())};
  for (const GraphPart& part : parts) PutPoses(part, copy);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(copy.poses[i].matrix(), graph.poses[i].matrix());
}

// Two walks with alternating poses in one graph end with the same bits as each walk alone: no part stops early because
// the objective of the other is a million times as large.
TEST(PartsOf, AreSolvedAsIfTheOthersWereNotThere) {
  RandomGraphs random(2);
  PoseGraph near = random.Walk(12, 1e-3, false), far = random.Walk(12, 0.3, false), both;
  for (PoseGraph* graph : {&near, &far})
    for (std::size_t i = 1; i < 12; ++i) graph->poses[i] = graph->poses[i] * Exp(random.Tangent(0.05, 0.05));
  for (std::size_t i = 0; i < 12; ++i)
    for (const PoseGraph* graph : {&near, &far}) both.poses.push_back(graph->poses[i]);
  for (const auto& [graph, shift] : {std::pair{&near, 0u}, std::pair{&far, 1u}})
    for (GraphEdge edge : graph->edges) {
      edge.from = 2 * edge.from + shift;
      edge.to = 2 * edge.to + shift;
      both.edges.push_back(edge);
    }
  const std::vector<GraphPart> parts = PartsOf(both);
  ASSERT_EQ(parts.size(), 2u);
  double sum = 0.0;
  PoseGraph solved = both;
  for (std::size_t p = 0; p < 2; ++p) {
    const OptimizeResult alone = Optimize(p == 0 ? near : far, {});
    GraphPart part = parts[p];
    OptimizeResult result = Optimize(part.graph, {});
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.objective, alone.objective);
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(result.poses[i].matrix(), alone.poses[i].matrix());
    sum += result.objective;
    part.graph.poses = result.poses;
    PutPoses(part, solved);
  }
  EXPECT_NEAR(Evaluate(solved, Objective::kB), sum, 1e-12 * sum);
}

}  // namespace
}  // namespace merlin
