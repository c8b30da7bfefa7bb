#include "slam/register/thin_source.h"

#include <gtest/gtest.h>

#include "slam/map/voxel_map.h"

namespace merlin {
namespace {

// A square wall of that size, a point every 5 mm.
std::vector<Point> Wall(double size_m) {
  std::vector<Point> points;
  for (double y = 0.0; y < size_m; y += 0.005)
    for (double z = 0.0; z < size_m; z += 0.005)
      points.push_back({.position = Eigen::Vector3d(2.0, y, z).cast<float>(), .sigma_m = 0.01f});
  return points;
}

TEST(ThinSource, GivesOnePointPerVoxelWhereThoseAreEnough) {
  const std::vector<Point> wall = Wall(1.6);  // 20 x 20 voxels of 8 cm
  const std::vector<Point> thin = ThinSource(wall, 0.08, 200), same = Downsample(wall, 0.08);
  ASSERT_EQ(thin.size(), same.size());
  for (std::size_t i = 0; i < thin.size(); ++i) EXPECT_EQ(thin[i].position, same[i].position);
}

TEST(ThinSource, UsesFinerVoxelsWhereTheViewIsSmall) {
  const std::vector<Point> wall = Wall(0.35);  // 10 deg at 2 m: 25 voxels of 8 cm
  EXPECT_LT(Downsample(wall, 0.08).size(), 40u);
  const std::size_t thin = ThinSource(wall, 0.08, 200).size();
  EXPECT_GE(thin, 200u);
  EXPECT_LT(thin, 600u) << "no finer than needed: each step about doubles the number";
}

TEST(ThinSource, TakesAllPointsWhereThereAreNoMore) {
  EXPECT_TRUE(ThinSource({}, 0.08, 200).empty());
  EXPECT_EQ(ThinSource(Wall(0.05), 0.08, 200).size(), Wall(0.05).size());
}

}  // namespace
}  // namespace merlin
