#include "scenarios/judge/map_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "scenarios/judge/point_grid.h"
#include "tests/scenarios/judge/synthetic_room.h"

namespace merlin {
namespace {

constexpr double kTolerance_m = 2e-6;       // the points are floats
const Outline kPlan = Rectangle(6.0, 4.0);  // its first edge runs along x: [0] is the distance in y

TEST(MapSize, MeasuresARoomAsLargeAsItsPlan) {
  const MapSize size = MeasureMapSize(CloudOfWalls(kPlan), Pose::Identity(), kPlan);
  EXPECT_NEAR(size.plan_m[0].value(), 4.0, 1e-12);
  EXPECT_NEAR(size.plan_m[1].value(), 6.0, 1e-12);
  EXPECT_NEAR(size.size_m[0].value(), 4.0, kTolerance_m);
  EXPECT_NEAR(size.size_m[1].value(), 6.0, kTolerance_m);
  EXPECT_NEAR(size.error_percent[0].value(), 0.0, 1e-4);
}

TEST(MapSize, GivesErrorsWithoutSignForSmallerAndLarger) {
  const MapSize size = MeasureMapSize(CloudOfWalls(Rectangle(6.12, 3.9)), Pose::Identity(), kPlan);
  EXPECT_NEAR(size.size_m[0].value(), 3.9, kTolerance_m);
  EXPECT_NEAR(size.size_m[1].value(), 6.12, kTolerance_m);
  EXPECT_NEAR(size.error_percent[0].value(), 2.5, 1e-4);
  EXPECT_NEAR(size.error_percent[1].value(), 2.0, 1e-4);
}

TEST(MapSize, DoesNotCareWhichWayRoundTheOutlineRuns) {
  Outline clockwise = kPlan;
  std::reverse(clockwise.begin() + 1, clockwise.end());  // the first edge now runs along y
  const MapSize size = MeasureMapSize(CloudOfWalls(Rectangle(6.12, 3.9)), Pose::Identity(), clockwise);
  EXPECT_NEAR(size.size_m[0].value(), 6.12, kTolerance_m);
  EXPECT_NEAR(size.size_m[1].value(), 3.9, kTolerance_m);
}

TEST(MapSize, MeasuresAfterTheAlignment) {
  const Pose T_world_map = FromXyYaw(-3.0, 20.0, 2.0);
  std::vector<MapPoint> map = CloudOfWalls(kPlan);
  for (MapPoint& point : map) point.p_map = (T_world_map.inverse() * point.p_map.cast<double>()).cast<float>();
  const MapSize size = MeasureMapSize(map, T_world_map, kPlan);
  EXPECT_NEAR(size.size_m[0].value(), 4.0, 1e-5);
  EXPECT_NEAR(size.size_m[1].value(), 6.0, 1e-5);
}

TEST(MapSize, AveragesNoiseOut) {
  std::vector<MapPoint> map = CloudOfWalls(kPlan);
  std::mt19937 generator(3);
  std::normal_distribution<float> noise_m(0.0f, 0.02f);
  for (MapPoint& point : map) point.p_map += Eigen::Vector3f(noise_m(generator), noise_m(generator), 0.0f);
  const MapSize size = MeasureMapSize(map, Pose::Identity(), kPlan);
  // Two walls of about 2700 points with 2 cm of noise: the error is 0.5 mm. Tolerance: five of these.
  EXPECT_NEAR(size.size_m[0].value(), 4.0, 0.0027);
  EXPECT_NEAR(size.size_m[1].value(), 6.0, 0.0027);
}

TEST(MapSize, FollowsTheLargestWallNotWhatStandsBeforeIt) {
  std::vector<MapPoint> map = CloudOfWalls(kPlan);
  AddWall(map, {-1.0, -1.7}, {1.0, -1.7});       // a cupboard's front, 0.3 m before the wall
  AddWall(map, {-2.9, -1.0}, {2.9, -1.0}, 0.2);  // a kerb, below 0.3 m
  for (int i = 0; i < 4000; ++i)                 // a shelf: level, so its normal is none of the wall's
    map.push_back({{-2.0f + 0.05f * static_cast<float>(i / 50), -1.95f + 0.02f * static_cast<float>(i % 50), 1.0f}});
  EXPECT_NEAR(MeasureMapSize(map, Pose::Identity(), kPlan).size_m[0].value(), 4.0, 0.002);
}

TEST(MapSize, LeavesOutWallsBeyondReach) {
  std::vector<MapPoint> map = CloudOfWalls(Rectangle(6.0, 4.0 - 2.0 * 1.6));  // an inner wall 1.6 m inside
  EXPECT_FALSE(MeasureMapSize(map, Pose::Identity(), kPlan).size_m[0]);
  EXPECT_TRUE(MeasureMapSize(CloudOfWalls(Rectangle(6.0, 4.0 - 2.0 * 1.4)), Pose::Identity(), kPlan).size_m[0]);
}

TEST(MapSize, IsNotKnownWhereAWallIsMissing) {
  std::vector<MapPoint> map;
  const std::vector<OutlineWall> walls = Walls(kPlan);
  for (const std::size_t seen : {0u, 1u, 2u}) AddWall(map, walls[seen].a_m, walls[seen].b_m);
  const MapSize size = MeasureMapSize(map, Pose::Identity(), kPlan);
  EXPECT_TRUE(size.size_m[0]);
  EXPECT_FALSE(size.size_m[1]);
  EXPECT_FALSE(size.error_percent[1]);
  EXPECT_TRUE(size.plan_m[1]);
}

TEST(MapSize, IsNotKnownForAnEmptyMapOrRoom) {
  EXPECT_FALSE(MeasureMapSize({}, Pose::Identity(), kPlan).size_m[0]);
  EXPECT_FALSE(MeasureMapSize(CloudOfWalls(kPlan), Pose::Identity(), {}).size_m[0]);
  const Outline triangle{{0, 0}, {4, 0}, {0, 4}};  // no wall has an opposite one
  EXPECT_FALSE(MeasureMapSize(CloudOfWalls(triangle), Pose::Identity(), triangle).plan_m[0]);
}

TEST(MapSize, PassesOverPointsThatAreNotFinite) {
  std::vector<MapPoint> map = CloudOfWalls(kPlan);
  map.push_back({Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())});
  map.push_back({Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity())});
  map.push_back({Eigen::Vector3f::Constant(-3e38f)});
  EXPECT_NEAR(MeasureMapSize(map, Pose::Identity(), kPlan).size_m[0].value(), 4.0, kTolerance_m);
}

TEST(MapSize, TakesTheFarthestOppositeWallOfALShapedRoom) {
  const Outline l_shape{{0, 0}, {6, 0}, {6, 2}, {3, 2}, {3, 5}, {0, 5}};
  const MapSize size = MeasureMapSize(CloudOfWalls(l_shape), Pose::Identity(), l_shape);
  EXPECT_NEAR(size.size_m[0].value(), 5.0, kTolerance_m);
  EXPECT_NEAR(size.size_m[1].value(), 6.0, kTolerance_m);
}

TEST(PointGrid, FindsWhatASearchOverAllPointsFinds) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto random_point = [&] { return Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator)); };
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 2000; ++i) points.push_back(random_point());
  const PointGrid grid(points, 0.15);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = random_point();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), expected_sum = Eigen::Vector3d::Zero();
    int count = 0, expected_count = 0;
    grid.VisitAround(p, [&](const Eigen::Vector3d& q) { sum += q, ++count; });
    for (const Eigen::Vector3d& q : points)
      if ((q - p).norm() <= 0.15) expected_sum += q, ++expected_count;
    EXPECT_EQ(count, expected_count);
    EXPECT_LT((sum - expected_sum).norm(), 1e-12);
  }
}

TEST(NormalAt, IsThePlanesNormalAndNothingForTooFewOrALine) {
  std::vector<Eigen::Vector3d> plane, line;
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 3).normalized();
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  for (int i = -3; i <= 3; ++i) {
    line.push_back(0.03 * i * u);
    for (int k = -3; k <= 3; ++k) plane.push_back(0.03 * i * u + 0.03 * k * v);
  }
  const std::optional<Eigen::Vector3d> found = NormalAt(PointGrid(plane, 0.15), Eigen::Vector3d::Zero());
  ASSERT_TRUE(found);
  EXPECT_NEAR(std::abs(found->dot(normal)), 1.0, 1e-12);
  EXPECT_FALSE(NormalAt(PointGrid(line, 0.15), Eigen::Vector3d::Zero()));
  EXPECT_FALSE(NormalAt(PointGrid({u, u, u, u, u}, 2.0), u));  // one place
  EXPECT_FALSE(NormalAt(PointGrid({0.1 * u, 0.1 * v, -0.1 * u, -0.1 * v}, 0.15), Eigen::Vector3d::Zero()));
  EXPECT_FALSE(NormalAt(PointGrid({}, 0.15), Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace merlin
