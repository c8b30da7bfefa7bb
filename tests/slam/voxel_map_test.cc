#include "slam/map/voxel_map.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "slam/map/nearest_search.h"

namespace merlin {
namespace {

std::vector<Point> Scatter(int count, double size_m, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> at(static_cast<float>(-size_m), static_cast<float>(size_m));
  std::vector<Point> points(count);
  for (Point& point : points) point = {.position = {at(random), at(random), at(random)}, .sigma_m = 0.01f};
  return points;
}

TEST(VoxelMap, FindsTheSameNearestSurfaceAsBruteForce) {
  // Any neighbourhood counts as a plane here, so that every voxel may be found.
  VoxelMap map({.voxel_m = 0.1, .flatness_max = 1.0, .plane_points_min = 3});
  map.Insert(Scatter(3000, 1.0, 1), Pose::Identity(), 0.0);
  int found = 0;
  for (const Point& query : Scatter(500, 1.0, 2)) {
    const Eigen::Vector3i home = (query.position / 0.1f).array().floor().cast<int>();
    const Voxel* expected = nullptr;
    for (const Voxel& voxel : map.voxels()) {
      const Eigen::Vector3i cell(voxel.cell[0], voxel.cell[1], voxel.cell[2]);
      if (!voxel.has_normal() || (cell - home).cwiseAbs().maxCoeff() > 1) continue;
      if (!expected || (voxel.mean - query.position).norm() < (expected->mean - query.position).norm())
        expected = &voxel;
    }
    const Voxel* nearest = map.Nearest(query.position);
    ASSERT_EQ(nearest == nullptr, expected == nullptr);
    if (nearest == nullptr) continue;
    EXPECT_EQ(nearest->cell, expected->cell);
    ++found;
  }
  EXPECT_GT(found, 400);
}

TEST(NearestSearch, FindsTheMapsNearest) {
  VoxelMap map({.voxel_m = 0.1, .flatness_max = 1.0, .plane_points_min = 3});
  map.Insert(Scatter(3000, 1.0, 1), Pose::Identity(), 0.0);
  for (const std::size_t expected_points : {0u, 100000u}) {
    NearestSearch search(map, expected_points);
    for (int round = 0; round < 2; ++round)
      for (const Point& query : Scatter(2000, 1.5, 2))
        ASSERT_EQ(search.Nearest(query.position), map.Nearest(query.position));
    EXPECT_EQ(search.Nearest({std::nanf(""), 0.0f, 0.0f}), nullptr);
    EXPECT_EQ(search.Nearest({1e30f, 0.0f, 0.0f}), nullptr);
  }
  const VoxelMap empty({});
  EXPECT_EQ(NearestSearch(empty, 10).Nearest({0.0f, 0.0f, 0.0f}), nullptr);
}

TEST(VoxelMap, GivesAPlaneItsNormalAcrossTheOrigin) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-0.5, 0.5);
  const Eigen::Vector3d normal = Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0;
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Point> points(4000);
  for (Point& point : points) point = {.position = (at(random) * u + at(random) * v).cast<float>(), .sigma_m = 0.01f};
  VoxelMap map({});
  map.Insert(points, Pose::Identity(), 0.0);
  const Voxel* voxel = map.Nearest(Eigen::Vector3f::Zero());
  ASSERT_NE(voxel, nullptr);
  EXPECT_NEAR(std::abs(voxel->normal.cast<double>().dot(normal)), 1.0, 1e-4);
  EXPECT_NEAR(voxel->mean.cast<double>().dot(normal), 0.0, 1e-4);
}

TEST(VoxelMap, HasNoNormalForALineOrASinglePoint) {
  VoxelMap map({});
  std::vector<Point> line(100);
  for (int i = 0; i < 100; ++i) line[i] = {.position = {0.002f * i, 0.05f, 0.05f}, .sigma_m = 0.01f};
  map.Insert(std::span(line).first(1), Pose::Identity(), 0.0);
  EXPECT_EQ(map.Nearest(line[0].position), nullptr);
  map.Insert(line, Pose::Identity(), 0.0);
  for (const Voxel& voxel : map.voxels()) EXPECT_TRUE(!voxel.has_normal() || std::abs(voxel.normal.x()) < 1e-3f);
}

TEST(VoxelMap, ForgetsWhatWasNotSeenLately) {
  VoxelMap map({});
  map.Insert(Scatter(200, 0.3, 1), Pose::Identity(), 0.0);
  map.Insert(Scatter(200, 0.3, 1), FromXyYaw(5.0, 0.0, 0.0), 7.0);
  map.ForgetBefore(3.0);
  ASSERT_FALSE(map.voxels().empty());
  for (const Voxel& voxel : map.voxels()) EXPECT_GT(voxel.mean.x(), 4.0f);
  map.ForgetBefore(8.0);
  EXPECT_TRUE(map.voxels().empty());
  EXPECT_EQ(map.Nearest(Eigen::Vector3f(5.0f, 0.0f, 0.0f)), nullptr);
}

TEST(VoxelMap, WeighsPointsByTheirPrecision) {
  VoxelMap map({.voxel_m = 1.0});
  const std::vector<Point> points{{.position = {0.2f, 0.5f, 0.5f}, .sigma_m = 0.01f},
                                  {.position = {0.7f, 0.5f, 0.5f}, .sigma_m = 0.02f}};
  map.Insert(points, Pose::Identity(), 0.0);
  ASSERT_EQ(map.voxels().size(), 1u);
  EXPECT_NEAR(map.voxels()[0].mean.x(), (4.0 * 0.2 + 1.0 * 0.7) / 5.0, 1e-6);  // 1 / sigma^2: 4 to 1
}

TEST(VoxelMap, TakesTheColourOfTheBestView) {
  std::vector<Point> wall;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      wall.push_back({.position = {0.5f, 0.025f * i + 0.0125f, 0.025f * j + 0.0125f}, .sigma_m = 0.01f});
  VoxelMap map({});
  map.Insert(wall, Pose::Identity(), 0.0);
  const Voxel& voxel = *map.Nearest({0.5f, 0.25f, 0.25f});
  EXPECT_FALSE(voxel.has_color());
  // Red from 1 m in front; blue from 2 m away, at 60 deg: (cos 60 / 4)^2 = 1/64 of its weight.
  const auto paint = [&](std::array<std::uint8_t, 3> bgr, const Eigen::Vector3f& from) {
    const std::vector<Point> point{{.position = voxel.mean, .bgr = bgr, .has_color = true},
                                   {.position = voxel.mean, .bgr = {9, 9, 9}},
                                   {.position = {std::nanf(""), 0.0f, 0.0f}, .has_color = true},
                                   {.position = {5.0f, 0.0f, 0.0f}, .has_color = true}};
    map.Paint(point, from, Pose::Identity());
  };
  paint({200, 0, 0}, voxel.mean + Eigen::Vector3f(-1.0f, std::sqrt(3.0f), 0.0f));
  EXPECT_TRUE(voxel.bgr().isApprox(Eigen::Vector3d(200.0, 0.0, 0.0), 1e-9));
  paint({0, 0, 200}, voxel.mean - Eigen::Vector3f::UnitX());
  EXPECT_TRUE(voxel.bgr().isApprox(Eigen::Vector3d(200.0 / 65.0, 0.0, 200.0 * 64.0 / 65.0), 1e-4))
      << voxel.bgr().transpose();
}

TEST(VoxelMap, RemovesTheRequestedVoxels) {
  VoxelMap map({.voxel_m = 0.1, .flatness_max = 1.0, .plane_points_min = 3});
  map.Insert(Scatter(3000, 0.5, 1), Pose::Identity(), 0.0);
  const std::vector<Voxel> before = map.voxels();
  std::vector<bool> every_second(before.size());
  for (std::size_t i = 0; i < before.size(); i += 2) every_second[i] = true;
  map.Forget(every_second);
  ASSERT_EQ(map.voxels().size(), before.size() / 2);
  for (std::size_t i = 0; i < map.voxels().size(); ++i) {
    EXPECT_EQ(map.voxels()[i].cell, before[2 * i + 1].cell);
    EXPECT_TRUE(!map.voxels()[i].has_normal() || map.Nearest(map.voxels()[i].mean) == &map.voxels()[i]);
  }
}

TEST(VoxelMap, LeavesOutPointsThatAreNotFinite) {
  VoxelMap map({});
  const float bad[] = {std::nanf(""), HUGE_VALF, 1e30f};
  for (const float value : bad) {
    const std::vector<Point> points{{.position = {value, 0.0f, 0.0f}, .sigma_m = 0.01f}};
    map.Insert(points, Pose::Identity(), 0.0);
    EXPECT_TRUE(map.voxels().empty());
    EXPECT_EQ(map.Nearest(points[0].position), nullptr);
    EXPECT_TRUE(Downsample(points, 0.1).empty());
  }
}

// Bit by bit, because a map of key frames must not depend on how it was made.
TEST(VoxelMap, InsertsManyFramesAsOneAfterTheOther) {
  for (const int count : {0, 1, 2, 12}) {
    VoxelMap one_by_one({.voxel_m = 0.1, .flatness_max = 1.0, .plane_points_min = 3});
    one_by_one.Insert(Scatter(500, 0.5, 99), FromXyYaw(0.1, 0.0, 0.2), 1.0);  // what was there before
    VoxelMap together = one_by_one;
    std::vector<std::vector<Point>> points;
    std::vector<PlacedPoints> frames;
    for (int i = 0; i < count; ++i) {
      points.push_back(Scatter(i == 1 ? 0 : 400, 0.5, static_cast<std::uint32_t>(i)));
      for (std::size_t k = 0; k < points.back().size(); k += 50) {
        points.back()[k].position.x() = k % 100 == 0 ? std::nanf("") : 1e30f;
        points.back()[k + 1].sigma_m = k % 100 == 0 ? HUGE_VALF : std::nanf("");
        points.back()[k + 2].position = points.back()[k + 3].position;
      }
    }
    for (int i = 0; i < count; ++i) frames.push_back({points[i], FromXyYaw(0.2 * i, -0.1 * i, 0.3 * i)});
    for (const PlacedPoints& frame : frames) one_by_one.Insert(frame.points_base, frame.T_map_base, 2.0);
    together.InsertAll(frames, 2.0);
    ASSERT_EQ(together.voxels().size(), one_by_one.voxels().size());
    for (std::size_t i = 0; i < together.voxels().size(); ++i) {
      const Voxel &a = together.voxels()[i], &b = one_by_one.voxels()[i];
      EXPECT_EQ(a.cell, b.cell);
      EXPECT_EQ(a.count, b.count);
      EXPECT_EQ(a.weight, b.weight);
      EXPECT_EQ(a.sum, b.sum);
      EXPECT_EQ(a.squares, b.squares);
      EXPECT_EQ(a.mean, b.mean);
      EXPECT_EQ(a.normal, b.normal);
      EXPECT_EQ(a.last_seen_m, b.last_seen_m);
    }
  }
}

// The surface by the definition: the least eigenvector of all points in the 27 voxels.
TEST(VoxelMap, GivesEveryVoxelTheSurfaceOfItsNeighbourhood) {
  const VoxelMapConfig config{.voxel_m = 0.2, .flatness_max = 1.0, .plane_points_min = 3};
  const std::vector<Point> first = Scatter(300, 0.5, 5), second = Scatter(300, 0.5, 6);
  const std::vector<PlacedPoints> frames{{first, Pose::Identity()}, {second, Pose::Identity()}};
  VoxelMap map(config);
  map.InsertAll(frames, 0.0);
  int compared = 0;
  for (const Voxel& voxel : map.voxels()) {
    const Eigen::Vector3i home(voxel.cell[0], voxel.cell[1], voxel.cell[2]);
    std::vector<Eigen::Vector3d> near;
    bool later = false;  // a voxel only the first frame met knows nothing of the second
    for (const auto* points : {&first, &second})
      for (const Point& point : *points) {
        const Eigen::Vector3i cell = (point.position.cast<double>() / config.voxel_m).array().floor().cast<int>();
        later = later || (points == &second && cell == home);
        if ((cell - home).cwiseAbs().maxCoeff() <= 1) near.push_back(point.position.cast<double>());
      }
    if (!later || near.size() < 3) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : near) mean += p / static_cast<double>(near.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : near)
      covariance += (p - mean) * (p - mean).transpose() / static_cast<double>(near.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Eigen::Vector3d values = solver.eigenvalues();
    if (values(0) > 0.9 * values(1)) continue;  // either direction would do
    EXPECT_NEAR(std::abs(voxel.normal.cast<double>().dot(solver.eigenvectors().col(0))), 1.0, 1e-3);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

TEST(Downsample, KeepsOneMeanPointAVoxel) {
  EXPECT_TRUE(Downsample({}, 0.1).empty());
  const std::vector<Point> points{
      {.position = {0.01f, 0, 0}}, {.position = {0.03f, 0, 0}}, {.position = {-0.01f, 0, 0}}};
  const std::vector<Point> thin = Downsample(points, 0.1);
  ASSERT_EQ(thin.size(), 2u);
  EXPECT_NEAR(thin[0].position.x(), 0.02f, 1e-7f);
  EXPECT_NEAR(thin[1].position.x(), -0.01f, 1e-7f);
}

}  // namespace
}  // namespace merlin
