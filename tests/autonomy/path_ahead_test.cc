#include "autonomy/path_ahead.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace merlin {
namespace {

using Path = std::vector<Eigen::Vector2d>;

TEST(PathAhead, LiesAcrossAStraightPath) {
  const PathAcross across = AcrossPath(Path{{0.0, 0.0}, {0.5, 0.0}, {0.5, 0.0}, {3.0, 0.0}}, 1.25, 0.24);
  for (std::size_t i = 0; i < across.size(); ++i)
    EXPECT_LT((across[i] - Eigen::Vector2d(1.25, -0.24 + 0.12 * static_cast<double>(i))).norm(), 1e-12) << i;
}

TEST(PathAhead, FollowsACurve) {
  Path path;
  for (double a = 0.0; a < 1.7; a += 0.01) path.push_back({std::sin(a), 1.0 - std::cos(a)});
  // A quarter of the circle around (0, 1) on: the path leads to the left, and its right edge is farther from the centre.
  const PathAcross across = AcrossPath(path, 0.5 * std::numbers::pi, 0.2);
  EXPECT_LT((across.front() - Eigen::Vector2d(1.2, 1.0)).norm(), 0.01);
  EXPECT_LT((across.back() - Eigen::Vector2d(0.8, 1.0)).norm(), 0.01);
}

TEST(PathAhead, EndsWhereThePathEnds) {
  EXPECT_LT((AcrossPath(Path{{0.0, 0.0}, {1.0, 0.0}}, 5.0, 0.2)[2] - Eigen::Vector2d(1.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((AcrossPath(Path{{0.3, 0.1}}, 5.0, 0.2)[4] - Eigen::Vector2d(0.3, 0.3)).norm(), 1e-12);
}

}  // namespace
}  // namespace merlin
