#include "slam/register/icp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace merlin {
namespace {

// Points of an open box corner: floor and two walls, each 2 x 2 m, seen from (1, 1, 1). Frame: the corner.
std::vector<Point> NoisyCorner(double sigma_m, std::uint32_t seed, bool floor = true, bool end = true) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigma_m > 0.0 ? sigma_m : 1.0);
  std::uniform_real_distribution<double> along(0.05, 2.0);
  std::vector<Point> points;
  for (int i = 0; i < 6000; ++i) {
    const double a = along(random), b = along(random), e = sigma_m > 0.0 ? noise(random) : 0.0;
    Eigen::Vector3d p;
    if (i % 3 == 0) p = {a, b, e};
    if (i % 3 == 1) p = {a, e, b};
    if (i % 3 == 2) p = {e, a, b};
    if ((i % 3 == 0 && !floor) || (i % 3 == 2 && !end)) continue;
    points.push_back({.position = p.cast<float>(), .sigma_m = static_cast<float>(std::max(sigma_m, 0.005))});
  }
  return points;
}

const Eigen::Vector3f kOrigin(1.0f, 1.0f, 1.0f);

std::vector<Point> MovedPoints(const std::vector<Point>& points, const Pose& T_base_corner) {
  std::vector<Point> moved = points;
  for (Point& point : moved) point.position = (T_base_corner * point.position.cast<double>()).cast<float>();
  return moved;
}

VoxelMap MapOf(const std::vector<Point>& points) {
  VoxelMap map({});
  map.Insert(points, Pose::Identity(), 0.0);
  return map;
}

PosePrior Guess(const Pose& T) { return {.T_map_base = T, .information = Matrix6d::Zero()}; }

TEST(Icp, FindsAKnownMotionFromSixCentimetresAndThreeDegreesAway) {
  const VoxelMap map = MapOf(NoisyCorner(0.005, 1));
  Vector6d tangent;
  tangent << 0.04, -0.03, 0.03, 0.03, -0.02, 0.04;
  const Pose T_map_base = Exp(tangent);
  const auto points_base = MovedPoints(NoisyCorner(0.005, 2), T_map_base.inverse());
  const RegisterResult result = Register(points_base, (T_map_base.inverse() * kOrigin.cast<double>()).cast<float>(),
                                         map, Guess(Pose::Identity()), {});
  EXPECT_TRUE(result.converged);
  EXPECT_LT((result.T_map_base.translation() - T_map_base.translation()).norm(), 0.002);
  EXPECT_LT(LogSo3(result.T_map_base.linear().transpose() * T_map_base.linear()).norm(), 0.002);
  // The point's own noise, and the map's: surfaces averaged over voxels, edges rounded by them.
  EXPECT_GT(result.rms_m, 0.0045);
  EXPECT_LT(result.rms_m, 0.010);
}

TEST(Icp, StaysAtTheTruthWhenItStartsThere) {
  const auto points = NoisyCorner(0.0, 1);
  const RegisterResult result = Register(points, kOrigin, MapOf(points), Guess(Pose::Identity()), {});
  EXPECT_TRUE(result.converged);
  EXPECT_LT(Log(result.T_map_base).norm(), 1e-3);  // voxels round the map's edges, and these pull a little
}

TEST(Icp, LeavesTheOpenAxisOfABareCorridorToThePrior) {
  const auto points = NoisyCorner(0.005, 1, true, false);  // floor and one wall along x: nothing holds x
  PosePrior prior = Guess(FromXyYaw(0.05, 0.02, 0.01));
  Vector6d sigma;
  sigma << 0.01, 0.05, 0.05, 0.05, 0.05, 0.05;
  prior.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const RegisterResult result = Register(points, kOrigin, MapOf(points), prior, {});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.T_map_base.translation().x(), 0.05, 0.005);  // half a sigma of the prior
  EXPECT_NEAR(result.T_map_base.translation().y(), 0.0, 0.003);
  EXPECT_NEAR(std::sqrt(result.covariance(0, 0)), 0.01, 0.002);  // no more known along x than the prior knew
  EXPECT_LT(std::sqrt(result.covariance(1, 1)), 0.003);
}

TEST(Icp, SaysThatItDidNotConverge) {
  const VoxelMap map = MapOf(NoisyCorner(0.0, 1));
  EXPECT_FALSE(Register({}, kOrigin, map, Guess(Pose::Identity()), {}).converged);
  const auto points = NoisyCorner(0.0, 1);
  EXPECT_FALSE(Register(std::span(points).first(1), kOrigin, map, Guess(Pose::Identity()), {}).converged);
  EXPECT_FALSE(Register(points, kOrigin, VoxelMap({}), Guess(Pose::Identity()), {}).converged);
  EXPECT_FALSE(Register(points, kOrigin, map, Guess(FromXyYaw(50.0, 0.0, 0.0)), {}).converged);
  auto broken = points;
  for (Point& point : broken) point.position.setConstant(std::nanf(""));
  EXPECT_FALSE(Register(broken, kOrigin, map, Guess(Pose::Identity()), {}).converged);
}

TEST(Icp, HoldsAgainstThreeTenthsOfThePointsBeingSomethingElse) {
  const VoxelMap map = MapOf(NoisyCorner(0.003, 1));
  const Pose T_map_base = FromXyYaw(0.03, -0.02, 0.02);
  auto points = MovedPoints(NoisyCorner(0.003, 2), T_map_base.inverse());
  for (std::size_t i = 0; i < points.size(); ++i)  // some of every surface
    if (i % 10 < 3) points[i].position += Eigen::Vector3f(0.12f, 0.12f, 0.12f);
  const RegisterResult result = Register(points, kOrigin, map, Guess(Pose::Identity()), {});
  EXPECT_TRUE(result.converged);
  EXPECT_LT((result.T_map_base.translation() - T_map_base.translation()).norm(), 0.012);
}

// Around a corner a frame shows far more new surfaces than surfaces that the map has.
TEST(Icp, ConvergesWhenMostPointsAreSeenForTheFirstTime) {
  const VoxelMap map = MapOf(NoisyCorner(0.003, 1));
  const Pose T_map_base = FromXyYaw(0.03, -0.02, 0.02);
  auto points = MovedPoints(NoisyCorner(0.003, 2), T_map_base.inverse());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i % 10 != 0) points[i].position += Eigen::Vector3f(30.0f, 0.0f, 0.0f);
  const RegisterResult result = Register(points, kOrigin, map, Guess(Pose::Identity()), {});
  EXPECT_TRUE(result.converged);
  EXPECT_LT((result.T_map_base.translation() - T_map_base.translation()).norm(), 0.005);
}

TEST(Icp, GivesTheSameBitsTwice) {
  const VoxelMap map = MapOf(NoisyCorner(0.005, 1));
  const auto points = MovedPoints(NoisyCorner(0.005, 2), FromXyYaw(0.02, 0.01, 0.01));
  const auto a = Register(points, kOrigin, map, Guess(Pose::Identity()), {});
  const auto b = Register(points, kOrigin, map, Guess(Pose::Identity()), {});
  EXPECT_EQ(a.T_map_base.matrix(), b.T_map_base.matrix());
}

}  // namespace
}  // namespace merlin
