#include "slam/register/tracked_neighbours.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace merlin {
namespace {

std::optional<Neighbour> ByBruteForce(const std::vector<Eigen::Vector3d>& positions, const Eigen::Vector3d& query,
                                      double reach_m) {
  std::optional<Neighbour> best;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const Neighbour candidate{(positions[i] - query).squaredNorm(), i};
    if (candidate.squared_m2 <= reach_m * reach_m && (!best || candidate < *best)) best = candidate;
  }
  return best;
}

void ExpectSame(const std::optional<Neighbour>& a, const std::optional<Neighbour>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->index, b->index);
  EXPECT_NEAR(a->squared_m2, b->squared_m2, 1e-14);
}

TEST(TrackedNeighbours, AgreeWithBruteForceAfterStepsOfEverySize) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(0.0, 1.0);
  const auto point = [&] { return Eigen::Vector3d(at(random), at(random), at(random)); };
  std::vector<Eigen::Vector3d> positions(300), queries(100);
  for (auto& position : positions) position = point();
  for (std::size_t i = 0; i < 40; ++i) positions.push_back(positions[i]);  // twice: the lower index answers
  for (auto& query : queries) query = 1.5 * point();
  queries[0] = positions[3];
  const Neighbours tree(positions);
  for (const double reach_m : {0.05, 0.15, 1e9}) {
    TrackedNeighbours tracked(tree, positions, queries.size(), reach_m);
    for (const double step_m : {0.0, 1e-6, 0.01, 0.0, 0.3, 1e-3, 0.02, 2.0, 0.01})
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const Eigen::Vector3d query = queries[i] + step_m * (point() - Eigen::Vector3d::Constant(0.5));
        ExpectSame(tracked.Nearest(i, query), ByBruteForce(positions, query, reach_m));
      }
  }
}

TEST(TrackedNeighbours, HandleOnePointNoPointAndNaN) {
  const std::vector<Eigen::Vector3d> none, one{{1.0, 2.0, 3.0}};
  const Neighbours no_tree(none), tree(one);
  TrackedNeighbours nothing(no_tree, none, 1, 1.0), tracked(tree, one, 1, 1.0);
  for (int twice = 0; twice < 2; ++twice) {
    EXPECT_FALSE(nothing.Nearest(0, {0.0, 0.0, 0.0}));
    EXPECT_TRUE(tracked.Nearest(0, {1.5, 2.0, 3.0}));
    EXPECT_FALSE(tracked.Nearest(0, {2.1, 2.0, 3.0}));
    EXPECT_FALSE(tracked.Nearest(0, {std::nan(""), 2.0, 3.0}));
  }
}

}  // namespace
}  // namespace merlin
