#include "slam/register/align.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "slam/register/normals.h"

namespace merlin {
namespace {

constexpr AlignMethod kMethods[] = {AlignMethod::kPoint, AlignMethod::kPlane, AlignMethod::kGicp, AlignMethod::kAuto};

Cloud Moved(const Cloud& cloud, const Pose& T) {
  Cloud moved = cloud;
  for (auto& position : moved.positions) position = T * position;
  return moved;
}

Pose Motion(double metres, double radians) {
  Vector6d tangent;
  tangent << metres * Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0, radians * Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0;
  return Exp(tangent);
}

double Difference(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff(); }

// Floor, wall, end: 3 x 2 m each, as a camera with noise across the surfaces sees them.
Cloud Corner(double noise_m, std::uint32_t seed, int planes = 3) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> along(0.0, 3.0), across(0.0, 2.0);
  Cloud cloud;
  for (int i = 0; i < 3000; ++i) {
    const double a = along(random), b = across(random), e = noise_m * noise(random);
    if (i % 3 == 0) cloud.positions.push_back({a, b, e});
    if (i % 3 == 1 && planes > 1) cloud.positions.push_back({a, e, b});
    if (i % 3 == 2 && planes > 2) cloud.positions.push_back({e, 2.0 / 3.0 * a, b});
  }
  return cloud;
}

// The point sets of section 5.6 of the thesis: given points, a helix, random points.
const Cloud kData1{{{1, 2, 0},
                    {1, 2.5, .2},
                    {2, 4, .3},
                    {2.2, 5, 0},
                    {3, 6, .2},
                    {5, 5, 0},
                    {6, 4, 0},
                    {6, 2, 0},
                    {3, 3, 0},
                    {4.2, 1, 0},
                    {3, 0, 0},
                    {2, 1, 0},
                    {1, 2, 0},
                    {1, 2, 0}},
                   {}};
const Cloud kData2{{{1.1, 2, 0},
                    {1.4, 2.5, .1},
                    {2.2, 4, .2},
                    {2.5, 5, 0},
                    {3, 6, 0},
                    {5, 5, 0},
                    {6.2, 4.3, 0},
                    {6, 2.4, 0},
                    {3, 3, 0},
                    {4.2, 1, 0},
                    {3.2, 0, 0},
                    {2, 1.3, 0},
                    {1.6, 2.1, 0},
                    {1, 2, 0}},
                   {}};

Cloud Helix() {
  Cloud cloud;
  for (int i = 0; i <= 500; ++i) {
    const double t = 0.02 * std::numbers::pi * i;
    cloud.positions.push_back({std::sin(t), std::cos(t), t});
  }
  return cloud;
}

Cloud Scattered(int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(0.0, 5.0);
  Cloud cloud;
  for (int i = 0; i < count; ++i) cloud.positions.push_back({at(random), at(random), at(random)});
  return cloud;
}

TEST(Align, LeavesNextToNoErrorOnTheThesisPoints) {
  for (const Cloud& source : {kData1, Helix(), Scattered(14), Scattered(500)})
    for (const AlignMethod method : {AlignMethod::kPoint, AlignMethod::kAuto}) {
      const Pose T = Motion(0.15, 0.08);
      const AlignResult result = Align(source, Moved(source, T), Pose::Identity(), {.method = method});
      EXPECT_TRUE(result.converged()) << source.size();
      EXPECT_EQ(result.method, AlignMethod::kPoint);
      EXPECT_LT(Difference(result.T_target_source, T), 1e-12) << source.size();
      EXPECT_LT(result.rms_m, 1e-12);
      EXPECT_EQ(result.inliers, static_cast<int>(source.size()));
    }
}

TEST(Align, OfTheThesisTwoSetsEndsAtTheBestMotionOfItsPairs) {
  // data2 is no moved data1: what remains is what no motion takes away. Pairs by brute force, motion by Eigen's
  // Umeyama.
  const AlignResult result = Align(kData1, kData2, Pose::Identity(), {.method = AlignMethod::kPoint});
  ASSERT_TRUE(result.converged());
  Eigen::Matrix3Xd source(3, 14), target(3, 14);
  for (int i = 0; i < 14; ++i) {
    source.col(i) = kData1.positions[static_cast<std::size_t>(i)];
    const Eigen::Vector3d moved = result.T_target_source * source.col(i);
    double best = HUGE_VAL;
    for (const auto& candidate : kData2.positions)
      if ((candidate - moved).norm() < best) best = (candidate - moved).norm(), target.col(i) = candidate;
  }
  EXPECT_LT((result.T_target_source.matrix() - Eigen::umeyama(source, target, false)).norm(), 1e-9);
  EXPECT_LT(result.rms_m, 0.19);
}

TEST(Align, FindsAKnownMotionInNoiseByEachMethod) {
  const Cloud source = Corner(0.005, 1), target = Corner(0.005, 2);
  const Pose T = Motion(0.15, 0.087);
  for (const AlignMethod method : {AlignMethod::kPlane, AlignMethod::kGicp, AlignMethod::kAuto}) {
    const AlignResult result = Align(source, Moved(target, T), Pose::Identity(), {.method = method});
    EXPECT_TRUE(result.converged());
    const Pose error = T.inverse() * result.T_target_source;
    // 1000 points a surface at 5 mm: a few tenths of a millimetre, and what the corners round.
    EXPECT_LT(error.translation().norm(), 0.002);
    EXPECT_LT(LogSo3(error.linear()).norm(), 0.002);
    EXPECT_EQ(result.undetermined.count(), 0);
  }
}

TEST(Align, HasErrorsOfOneToThreeOfItsSigmas) {
  // Over many noises, in the source frame: chi2 of 6 degrees has the mean 6, nine times that at three sigma. Above one
  // because pairs share target points and normals share neighbours.
  const Pose T = Motion(0.05, 0.03);
  double chi2 = 0.0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    const Cloud source = Moved(Corner(0.005, 100 + run), Pose(Eigen::Translation3d(5.0, 0.0, 0.0)));
    const Cloud target = Moved(Moved(Corner(0.005, 500 + run), Pose(Eigen::Translation3d(5.0, 0.0, 0.0))), T);
    const AlignResult result = Align(source, target, T, {.method = AlignMethod::kPlane});
    ASSERT_TRUE(result.converged());
    const Vector6d error = Log(T.inverse() * result.T_target_source);
    chi2 += error.dot(result.covariance.inverse() * error) / kRuns;
  }
  EXPECT_GT(chi2, 6.0);
  EXPECT_LT(chi2, 54.0);
}

TEST(Align, HoldsAgainstAPartThatOnlyOneCloudHas) {
  Cloud source = Corner(0.003, 1);
  const Cloud target = Corner(0.003, 2);
  for (int i = 0; i < 600; ++i) source.positions.push_back({2.0 + 0.001 * i, 1.0 + 0.3 * std::sin(0.1 * i), 0.2});
  const Pose T = Motion(0.08, 0.04);
  const AlignResult result = Align(source, Moved(target, T), Pose::Identity(), {});
  EXPECT_TRUE(result.converged());
  EXPECT_LT((T.inverse() * result.T_target_source).translation().norm(), 0.004);
}

TEST(Align, TrustsASurePointMoreThanAnUnsureOne) {
  // Two copies of one source point, 0 and 3 mm off: the mean goes to the one of small sigma.
  Cloud source = Scattered(20), target = source;
  source.sigma_m.assign(20, 0.01);
  target.sigma_m.assign(20, 0.01);
  for (int i = 0; i < 20; i += 2) {
    target.positions[static_cast<std::size_t>(i)].x() += 0.003;
    source.sigma_m[static_cast<std::size_t>(i)] = target.sigma_m[static_cast<std::size_t>(i)] = 10.0;
  }
  const AlignResult result = Align(source, target, Pose::Identity(), {.method = AlignMethod::kPoint});
  EXPECT_LT(result.T_target_source.translation().norm(), 1e-5);
}

TEST(Align, ReportsWhatABareCorridorAFloorAndALineLeaveUndetermined) {
  const Cloud corridor = Corner(0.003, 1, 2), floor = Corner(0.003, 1, 1);
  Cloud line;
  for (int i = 0; i < 200; ++i) line.positions.push_back({0.01 * i, 0.02 * i, 0.0});
  const struct {
    Cloud cloud;
    AlignMethod method;
    int open;
  } cases[] = {{corridor, AlignMethod::kGicp, 1},
               {corridor, AlignMethod::kPlane, 1},
               {floor, AlignMethod::kGicp, 3},
               {line, AlignMethod::kPoint, 1}};
  for (const auto& c : cases) {
    const AlignResult result = Align(c.cloud, c.cloud, Motion(0.01, 0.001), {.method = c.method});
    EXPECT_FALSE(result.converged());
    EXPECT_EQ(result.end, AlignEnd::kUndetermined);
    EXPECT_EQ(result.undetermined.count(), c.open);
    EXPECT_TRUE(result.covariance.isZero());
  }
  const AlignResult result = Align(corridor, corridor, Pose(Eigen::Translation3d(0.1, 0.02, 0.01)), {});
  ASSERT_EQ(result.undetermined.count(), 1);
  EXPECT_GT(std::abs(result.undetermined.directions(0, 0)), 0.99);
  EXPECT_NEAR(result.T_target_source.translation().x(), 0.1, 0.01);  // along it the result stays at the guess
  EXPECT_NEAR(result.T_target_source.translation().y(), 0.0, 0.002);
}

TEST(Align, DoesNotConvergeOnTooLittle) {
  const Cloud corner = Corner(0.0, 1), none, one{{{1, 2, 3}}, {}}, two{{{1, 2, 3}, {2, 3, 4}}, {}};
  const Cloud same{std::vector<Eigen::Vector3d>(300, {1, 2, 3}), {}};
  for (const AlignMethod method : kMethods)
    for (const Cloud* few : {&none, &one, &two, &same}) {
      for (const auto& [source, target] : {std::pair(few, &corner), std::pair(&corner, few), std::pair(few, few)}) {
        const AlignResult result = Align(*source, *target, Pose::Identity(), {.method = method});
        EXPECT_FALSE(result.converged()) << few->size();
        EXPECT_TRUE(result.T_target_source.matrix().allFinite());
        EXPECT_GT(result.undetermined.count(), 0);
      }
    }
  EXPECT_EQ(Align(corner, Moved(corner, FromXyYaw(50, 0, 0)), Pose::Identity(), {}).end, AlignEnd::kTooFewPairs);
  EXPECT_EQ(Align(corner, Moved(corner, Motion(0.1, 0.1)), Pose::Identity(), {.iterations_max = 2}).end,
            AlignEnd::kIterations);
}

TEST(Align, IsTheSameFarFromTheOriginAndInMillimetres) {
  const Cloud source = Corner(0.003, 1), target = Moved(Corner(0.003, 2), Motion(0.05, 0.03));
  const AlignResult near = Align(source, target, Pose::Identity(), {});
  const Pose grid(Eigen::Translation3d(500'000.0, 5'300'000.0, 400.0));
  const AlignResult far = Align(Moved(source, grid), Moved(target, grid), Pose::Identity(), {});
  ASSERT_TRUE(near.converged() && far.converged());
  // Coordinates of 5e6 carry 1e-9 m.
  EXPECT_LT(Difference(grid.inverse() * far.T_target_source * grid, near.T_target_source), 1e-6);
  Cloud source_mm = source, target_mm = target;
  for (auto* cloud : {&source_mm, &target_mm})
    for (auto& position : cloud->positions) position *= 1000.0;
  const AlignResult mm = Align(source_mm, target_mm, Pose::Identity(), {});
  ASSERT_TRUE(mm.converged());
  EXPECT_LT((mm.T_target_source.linear() - near.T_target_source.linear()).norm(), 1e-3);
}

TEST(Align, GivesTheSameBitsTwice) {
  const Cloud source = Corner(0.005, 1), target = Moved(Corner(0.005, 2), Motion(0.05, 0.03));
  for (const AlignMethod method : kMethods) {
    const auto a = Align(source, target, Pose::Identity(), {.method = method}),
               b = Align(source, target, Pose::Identity(), {.method = method});
    EXPECT_EQ(a.T_target_source.matrix(), b.T_target_source.matrix());
    EXPECT_EQ(a.covariance, b.covariance);
  }
}

// The cloud has more points than are used while the kernel narrows; the last steps use all of them.
TEST(Align, TakesEveryPointOfALargeCloudAtTheEnd) {
  Cloud source, target;
  for (std::uint32_t seed = 1; seed <= 8; ++seed)
    for (auto [cloud, shift] : {std::pair(&source, 0u), std::pair(&target, 100u)})
      for (const auto& position : Corner(0.004, seed + shift).positions) cloud->positions.push_back(position);
  const Pose T = Motion(0.08, 0.04);
  for (const Pose& guess : {T, Pose(Pose::Identity()), T * Motion(0.05, -0.05)}) {
    const AlignResult result = Align(source, Moved(target, T), guess, {});
    EXPECT_TRUE(result.converged());
    EXPECT_GT(result.inliers, 23'000);
    EXPECT_LT((T.inverse() * result.T_target_source).translation().norm(), 0.001);
  }
  const AlignResult same = Align(source, source, Pose::Identity(), {});
  EXPECT_TRUE(same.converged());
  EXPECT_LT(Difference(same.T_target_source, Pose::Identity()), 1e-9);
  Cloud floor;
  for (std::uint32_t seed = 1; seed <= 4; ++seed)
    for (const auto& position : Corner(0.003, seed, 1).positions) floor.positions.push_back(position);
  EXPECT_EQ(Align(floor, floor, Motion(0.01, 0.001), {}).undetermined.count(), 3);
  EXPECT_EQ(Align(source, Moved(target, FromXyYaw(50, 0, 0)), Pose::Identity(), {}).end, AlignEnd::kTooFewPairs);
  EXPECT_EQ(Align(source, Moved(target, T), Pose::Identity(), {.iterations_max = 2}).end, AlignEnd::kIterations);
}

TEST(AlignConfig, NamesItsFaults) {
  EXPECT_TRUE(Validate(AlignConfig{}).empty());
  EXPECT_EQ(Validate(AlignConfig{.max_distance_m = std::nan(""), .iterations_max = 0, .neighbours = 2}).size(), 3u);
}

TEST(Thin, KeepsOneMeanPointACubeInOrderOfAppearance) {
  EXPECT_EQ(Thin({}, 0.1).size(), 0u);
  const Cloud cloud{{{0.16, 0, 0}, {0.01, 0, 0}, {0.03, 0, 0}, {-0.01, 0, 0}, {0.02, 0, 0}}, {1, 2, 3, 4, 7}};
  const Cloud thin = Thin(cloud, 0.1);
  ASSERT_EQ(thin.size(), 3u);
  EXPECT_NEAR(thin.positions[0].x(), 0.16, 1e-15);
  EXPECT_NEAR(thin.positions[1].x(), 0.02, 1e-15);
  EXPECT_NEAR(thin.positions[2].x(), -0.01, 1e-15);
  EXPECT_NEAR(thin.sigma_m[1], 4.0, 1e-15);
}

TEST(ThinToFit, LeavesAtMostTwentyThousandPointsAndSmallCloudsAsTheyAre) {
  const Cloud none, small = Corner(0.005, 1);
  EXPECT_EQ(ThinToFit(none, small).voxel_m, 0.0);
  EXPECT_EQ(ThinToFit(none, small).target.positions, small.positions);
  const Cloud large = Scattered(50'000);
  const ThinPair thin = ThinToFit(small, large);
  EXPECT_LE(thin.target.size(), 20'000u);
  EXPECT_GT(thin.target.size(), 5'000u);
  EXPECT_EQ(thin.source.positions, Thin(small, thin.voxel_m).positions);
  EXPECT_EQ(thin.target.positions, Thin(large, thin.voxel_m).positions);
  const Cloud same{std::vector<Eigen::Vector3d>(30'000, {1, 2, 3}), {}};
  EXPECT_EQ(ThinToFit(same, small).source.size(), 1u);
  EXPECT_EQ(ThinToFit(same, same).voxel_m, 0.0);  // there is no length from which to choose a voxel
}

TEST(Surfaces, HaveTheirPlanesNormalsAndKnowCurves) {
  const Cloud floor = Corner(0.0, 1, 1);
  const Surfaces flat = FindSurfaces(floor, Neighbours(floor.positions), 20);
  EXPECT_GT(flat.share, 0.8);
  for (const auto& normal : flat.normals) EXPECT_NEAR(std::abs(normal.z()), 1.0, 1e-9);
  const Cloud helix = Helix(), full = Scattered(1000);
  EXPECT_LT(FindSurfaces(helix, Neighbours(helix.positions), 20).share, 0.1);
  EXPECT_LT(FindSurfaces(full, Neighbours(full.positions), 20).share, 0.3);
  const Cloud line{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, {}};
  for (const auto& normal : FindSurfaces(line, Neighbours(line.positions), 20).normals) EXPECT_TRUE(normal.isZero());
}

}  // namespace
}  // namespace merlin
