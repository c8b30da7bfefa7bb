#include "slam/register/rigid_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>
#include <vector>

namespace merlin {
namespace {

std::vector<PointPair> Pairs(const Pose& T, int count, double noise_m, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto three = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  std::vector<PointPair> pairs(static_cast<std::size_t>(count));
  for (PointPair& pair : pairs) {
    pair.source = three();
    pair.target = T * pair.source + noise_m * three();
  }
  return pairs;
}

TEST(RigidFit, FindsTheMotionOfExactPairsForAnyAngle) {
  for (const double angle_rad : {0.0, 1e-9, 0.3, 2.0, std::numbers::pi - 1e-9, std::numbers::pi, -3.0}) {
    Vector6d tangent;
    tangent << 1.0, -2.0, 3.0, angle_rad * Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0;
    const Pose T = Exp(tangent);
    EXPECT_LT((FitRigid(Pairs(T, 14, 0.0, 1)).matrix() - T.matrix()).norm(), 1e-13) << angle_rad;
  }
}

TEST(RigidFit, IsWhatEigensUmeyamaFindsInNoise) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto pairs = Pairs(FromXyYaw(1.0, 2.0, 0.5), 8, 0.3, seed);
    Eigen::Matrix3Xd source(3, 8), target(3, 8);
    for (int i = 0; i < 8; ++i) {
      source.col(i) = pairs[static_cast<std::size_t>(i)].source;
      target.col(i) = pairs[static_cast<std::size_t>(i)].target;
    }
    EXPECT_LT((FitRigid(pairs).matrix() - Eigen::umeyama(source, target, false)).norm(), 1e-12) << seed;
  }
}

TEST(RigidFit, NeverReflects) {
  // A plane's mirror image fits as well as its turn; a noisy mirrored cloud fits better mirrored.
  auto flat = Pairs(FromXyYaw(0.1, 0.0, 0.2), 10, 0.0, 3);
  for (PointPair& pair : flat) pair.source.z() = pair.target.z() = 0.0;
  auto mirrored = Pairs(Pose::Identity(), 10, 0.0, 4);
  for (PointPair& pair : mirrored) pair.target.z() = -pair.target.z();
  for (const auto& pairs : {flat, mirrored}) EXPECT_NEAR(FitRigid(pairs).linear().determinant(), 1.0, 1e-12);
}

TEST(RigidFit, WeighsAPairOfThreeAsThreePairs) {
  auto pairs = Pairs(FromXyYaw(0.3, -0.1, 0.1), 6, 0.2, 5);
  auto thrice = pairs;
  thrice.insert(thrice.end(), 2, pairs[0]);
  pairs[0].weight = 3.0;
  EXPECT_LT((FitRigid(pairs).matrix() - FitRigid(thrice).matrix()).norm(), 1e-12);
}

TEST(RigidFit, IsAProperMotionWhereThePairsHoldItInPart) {
  EXPECT_EQ(FitRigid({}).matrix(), Pose::Identity().matrix());
  const std::vector<PointPair> one{{{1.0, 2.0, 3.0}, {2.0, 2.0, 3.0}}};
  EXPECT_LT((FitRigid(one) * one[0].source - one[0].target).norm(), 1e-12);
  const std::vector<PointPair> line{{{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {0, 1, 0}}, {{2, 0, 0}, {0, 2, 0}}};
  const Pose T = FitRigid(line);
  EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-12);
  for (const PointPair& pair : line) EXPECT_LT((T * pair.source - pair.target).norm(), 1e-12);
}

}  // namespace
}  // namespace merlin
