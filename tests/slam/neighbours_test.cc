#include "slam/register/neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace merlin {
namespace {

std::vector<Neighbour> BruteForce(std::span<const Eigen::Vector3d> positions, const Eigen::Vector3d& query) {
  std::vector<Neighbour> all;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3d d = query - positions[i];
    all.push_back({d.x() * d.x() + d.y() * d.y() + d.z() * d.z(), static_cast<std::uint32_t>(i)});
  }
  std::ranges::sort(all);
  return all;
}

void ExpectBruteForce(const std::vector<Eigen::Vector3d>& positions, const Eigen::Vector3d& query) {
  const Neighbours neighbours(positions);
  const auto expected = BruteForce(positions, query);
  std::vector<Neighbour> found(7);
  const std::size_t count = neighbours.Nearest(query, found);
  ASSERT_EQ(count, std::min<std::size_t>(7, positions.size()));
  for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(found[i].index, expected[i].index) << i;
  const auto nearest = neighbours.Nearest(query, 0.25);
  ASSERT_EQ(nearest.has_value(), !expected.empty() && expected[0].squared_m2 <= 0.0625);
  EXPECT_EQ(nearest.value_or(Neighbour{}).index, nearest ? expected[0].index : 0u);
}

TEST(Neighbours, AgreeWithBruteForce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-1.0, 1.0);
  std::vector<Eigen::Vector3d> positions(500);
  for (auto& p : positions) p = {at(random), at(random), at(random)};
  for (int i = 0; i < 200; ++i) ExpectBruteForce(positions, {at(random), at(random), at(random)});
}

TEST(Neighbours, OfEqualDistanceAreOrderedByIndex) {
  // A lattice, every point twice, asked at its points, between two and at the middle of eight.
  std::vector<Eigen::Vector3d> positions;
  for (int twice = 0; twice < 2; ++twice)
    for (int i = 0; i < 216; ++i) positions.push_back({0.5 * (i % 6), 0.5 * (i / 6 % 6), 0.5 * (i / 36)});
  for (const double off : {0.0, 0.25})
    for (const auto& p : std::vector(positions.begin(), positions.begin() + 216)) {
      ExpectBruteForce(positions, p + Eigen::Vector3d(off, 0.0, 0.0));
      ExpectBruteForce(positions, p + Eigen::Vector3d(off, off, off));
    }
}

TEST(Neighbours, HandleNoPointOnePointAndEqualPoints) {
  ExpectBruteForce({}, {0, 0, 0});
  ExpectBruteForce({{0.1, 0, 0}}, {0, 0, 0});
  ExpectBruteForce(std::vector<Eigen::Vector3d>(100, {0.1, 0, 0}), {0, 0, 0});
  ExpectBruteForce(std::vector<Eigen::Vector3d>(100, {1e9, -1e9, 1e9}), {0, 0, 0});
}

TEST(Neighbours, AreNoneForAQueryThatIsNotFinite) {
  const std::vector<Eigen::Vector3d> positions(5, {0, 0, 0});
  const Neighbours neighbours(positions);
  std::vector<Neighbour> found(3);
  EXPECT_FALSE(neighbours.Nearest({std::nan(""), 0, 0}, 1.0));
  EXPECT_EQ(neighbours.Nearest({HUGE_VAL, 0, 0}, found), 0u);
}

}  // namespace
}  // namespace merlin
