#include "scenarios/judge/alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

#include "scenarios/judge/tum_file.h"
#include "tests/support/shared_data.h"

namespace merlin {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

Pose At(double x_m, double y_m, double z_m) { return Pose(Eigen::Translation3d(x_m, y_m, z_m)); }

std::vector<PosePair> RandomPairs(std::size_t count, double noise_m) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  const auto tangent = [&](double scale) {
    Vector6d v;
    for (double& value : v) value = scale * normal(generator);
    return v;
  };
  const Pose T_map_world = Exp(tangent(1.0));
  std::vector<PosePair> pairs;
  Pose T_world_base = Pose::Identity();
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 5 != 0) T_world_base = T_world_base * Exp(tangent(0.1));  // every fifth time it stands
    pairs.push_back({T_world_base, T_map_world * T_world_base * Exp(tangent(noise_m))});
  }
  return pairs;
}

TEST(PairAtEqualStamps, KeepsOnlyInstantsBothHave) {
  const Trajectory truth{
      {Time(1), At(1, 0, 0)}, {Time(2), At(2, 0, 0)}, {Time(4), At(4, 0, 0)}, {Time(5), At(5, 0, 0)}};
  const Trajectory estimate{{Time(0), At(0, 1, 0)},
                            {Time(2), At(2, 1, 0)},
                            {Time(3), At(3, 1, 0)},
                            {Time(5), At(5, 1, 0)},
                            {Time(6), At(6, 1, 0)}};
  const std::vector<PosePair> pairs = PairAtEqualStamps(truth, estimate);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].T_world_base.translation().x(), 2.0);
  EXPECT_EQ(pairs[0].T_map_base.translation(), Eigen::Vector3d(2, 1, 0));
  EXPECT_EQ(pairs[1].T_map_base.translation(), Eigen::Vector3d(5, 1, 0));
  EXPECT_TRUE(PairAtEqualStamps({}, estimate).empty());
  EXPECT_TRUE(PairAtEqualStamps(truth, {}).empty());
}

TEST(Ate, IsTheHeightOfCornersAlternatelyRaisedAndLowered) {
  // Corners of a square moved by +h, -h, +h, -h: no rigid motion fits better, so each error is h.
  const double h_m = 0.05;
  std::vector<PosePair> pairs{{At(1, 1, 0), At(1, 1, h_m)},
                              {At(-1, 1, 0), At(-1, 1, -h_m)},
                              {At(-1, -1, 0), At(-1, -1, h_m)},
                              {At(1, -1, 0), At(1, -1, -h_m)}};
  const Pose T_map_other = Exp((Vector6d() << 3, -2, 1, 0.3, -0.2, 2.0).finished());
  for (PosePair& pair : pairs) pair.T_map_base = T_map_other * pair.T_map_base;
  const std::optional<Ate> ate = AlignAndAte(pairs);
  ASSERT_TRUE(ate);
  EXPECT_NEAR(ate->rmse_m, h_m, 1e-12);
  EXPECT_TRUE(ate->T_world_map.isApprox(T_map_other.inverse(), 1e-9));
}

TEST(Ate, DoesNotScale) {
  // Corners of a square at 1 and at 1.1 of the distance: each is off by 0.1 sqrt(2).
  std::vector<PosePair> pairs;
  for (const auto& [x_m, y_m] : {std::pair(1, 1), std::pair(-1, 1), std::pair(-1, -1), std::pair(1, -1)})
    pairs.push_back({At(x_m, y_m, 0), At(1.1 * x_m, 1.1 * y_m, 0)});
  EXPECT_NEAR(AlignAndAte(pairs)->rmse_m, 0.1 * std::sqrt(2.0), 1e-12);
}

TEST(Ate, ScalesWhereAsked) {
  std::vector<PosePair> pairs;
  const Pose T_map_other = Exp((Vector6d() << 3, -2, 1, 0.3, -0.2, 2.0).finished());
  for (const auto& [x_m, y_m] : {std::pair(1, 1), std::pair(-1, 1), std::pair(-1, -1), std::pair(1, -1)})
    pairs.push_back({At(x_m, y_m, 0), T_map_other * At(0.8 * x_m, 0.8 * y_m, 0)});
  const Ate ate = *AlignAndAte(pairs, Alignment::kSim3);
  EXPECT_NEAR(ate.scale, 1.25, 1e-12);
  EXPECT_NEAR(ate.rmse_m, 0.0, 1e-12);
  EXPECT_EQ(AlignAndAte(pairs)->scale, 1.0);
  EXPECT_FALSE(
      AlignAndAte(std::vector<PosePair>{{At(0, 0, 0), At(1, 1, 1)}, {At(1, 0, 0), At(1, 1, 1)}}, Alignment::kSim3));
}

TEST(Ate, LeavesTheEstimateWhereItIsWhereAsked) {
  const std::vector<PosePair> pairs{{At(0, 0, 0), At(3, 4, 0)}, {At(1, 0, 0), At(1, 0, 1)}};
  const Ate ate = *AlignAndAte(pairs, Alignment::kNone);
  EXPECT_EQ(ate.T_world_map.matrix(), Pose::Identity().matrix());
  EXPECT_DOUBLE_EQ(ate.error_m.mean, 3.0);
  EXPECT_DOUBLE_EQ(ate.error_m.max, 5.0);
  EXPECT_DOUBLE_EQ(ate.rmse_m, std::sqrt(13.0));
}

TEST(ErrorStatistics, AgreeWithValuesByHand) {
  const ErrorStatistics odd = StatisticsOf({4.0, 1.0, 1.0});
  EXPECT_DOUBLE_EQ(odd.mean, 2.0);
  EXPECT_DOUBLE_EQ(odd.median, 1.0);
  EXPECT_DOUBLE_EQ(odd.spread, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(odd.rmse, std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(StatisticsOf({4.0, 1.0, 1.0, 2.0}).median, 1.5);
  EXPECT_DOUBLE_EQ(StatisticsOf({0.25}).median, 0.25);
  EXPECT_EQ(StatisticsOf({0.25}).spread, 0.0);
}

TEST(Ate, AgreesWithEigenUmeyama) {
  const std::vector<PosePair> pairs = RandomPairs(200, 0.05);
  Eigen::Matrix3Xd p_world(3, 200), p_map(3, 200);
  for (int i = 0; i < 200; ++i) {
    p_world.col(i) = pairs[static_cast<std::size_t>(i)].T_world_base.translation();
    p_map.col(i) = pairs[static_cast<std::size_t>(i)].T_map_base.translation();
  }
  const Pose expected(Eigen::Affine3d(Eigen::umeyama(p_map, p_world, false)).matrix());
  const Ate ate = *AlignAndAte(pairs);
  EXPECT_TRUE(ate.T_world_map.isApprox(expected, 1e-7));  // the orientations' weight turns it by less
  EXPECT_NEAR(ate.rmse_m, std::sqrt((p_world - expected * p_map).squaredNorm() / 200.0), 1e-12);

  const Eigen::Affine3d scaled(Eigen::umeyama(p_map, p_world, true));
  const Ate sim3 = *AlignAndAte(pairs, Alignment::kSim3);
  EXPECT_NEAR(sim3.scale, std::cbrt(scaled.linear().determinant()), 1e-9);
  EXPECT_NEAR(sim3.rmse_m, std::sqrt((p_world - scaled * p_map).squaredNorm() / 200.0), 1e-12);
}

TEST(Ate, TakesTheTurnFromOrientationsWherePositionsLeaveItOpen) {
  const Pose T_world_map = Exp((Vector6d() << 1, 2, 3, 0.4, -0.5, 0.6).finished());
  const auto expect_recovered = [&T_world_map](const std::vector<Pose>& poses_map) {
    std::vector<PosePair> pairs;
    for (const Pose& pose : poses_map) pairs.push_back({T_world_map * pose, pose});
    const std::optional<Ate> ate = AlignAndAte(pairs);
    ASSERT_TRUE(ate);
    EXPECT_NEAR(ate->rmse_m, 0.0, 1e-9);
    EXPECT_TRUE(ate->T_world_map.isApprox(T_world_map, 1e-5));
  };
  expect_recovered({At(5, 6, 7)});                              // one pose
  expect_recovered({At(5, 6, 7), At(5, 6, 7)});                 // standing
  expect_recovered({At(0, 0, 0), At(10, 0, 0), At(20, 0, 0)});  // a straight line
}

TEST(Ate, IsNothingForNoPairsOrNumbersThatAreNotFinite) {
  EXPECT_FALSE(AlignAndAte({}));
  std::vector<PosePair> pairs = RandomPairs(10, 0.0);
  pairs[3].T_map_base.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(AlignAndAte(pairs));
  EXPECT_FALSE(RpeOverOneMetre(pairs));
}

TEST(Rpe, IsTheErrorOfScaleOnAStraight) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 24; ++i) pairs.push_back({At(0.125 * i, 0, 0), At(0.1275 * i, 0, 0)});
  const std::optional<Rpe> rpe = RpeOverOneMetre(pairs);
  ASSERT_TRUE(rpe);
  EXPECT_EQ(rpe->pairs, 17u);  // all pairs over 1 m; the next start has only 0.875 m left
  EXPECT_NEAR(rpe->translation_percent, 2.0, 1e-9);
  EXPECT_NEAR(rpe->rotation_deg_per_m, 0.0, 1e-9);
}

TEST(Rpe, IsTheDriftOfYawPerMetre) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 80; ++i) {
    const double path_m = 0.125 * i;  // exact in binary: every pair is 1 m
    pairs.push_back({FromXyYaw(path_m, 0, 0), FromXyYaw(path_m, 0, 0.5 * kDegree_rad * path_m)});
  }
  const std::optional<Rpe> rpe = RpeOverOneMetre(pairs);
  ASSERT_TRUE(rpe);
  EXPECT_EQ(rpe->pairs, 73u);
  EXPECT_NEAR(rpe->rotation_deg_per_m, 0.5, 1e-9);
}

TEST(Rpe, IsZeroForAScaledEstimateIfScaleIsFitted) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 24; ++i) pairs.push_back({FromXyYaw(0.125 * i, 0, 0.1 * i), FromXyYaw(0.25 * i, 0, 0.1 * i)});
  const RelativeErrors errors = ErrorsOver(pairs, 0.5, 0.5);
  ASSERT_EQ(errors.translation_m.size(), 21u);
  for (const double error_m : errors.translation_m) EXPECT_NEAR(error_m, 0.0, 1e-12);
  EXPECT_NEAR(ErrorsOver(pairs, 0.5).translation_m[0], 0.5, 1e-12);
  EXPECT_TRUE(ErrorsOver(pairs, 4.0).translation_m.empty());
}

TEST(Rpe, IgnoresARigidTransformOfTheWhole) {
  std::vector<PosePair> pairs = RandomPairs(300, 0.02);
  const Rpe before = *RpeOverOneMetre(pairs);
  for (PosePair& pair : pairs) pair.T_map_base = Exp((Vector6d() << 9, 8, 7, 1, 2, 3).finished()) * pair.T_map_base;
  const Rpe after = *RpeOverOneMetre(pairs);
  EXPECT_NEAR(before.translation_percent, after.translation_percent, 1e-9);
  EXPECT_NEAR(before.rotation_deg_per_m, after.rotation_deg_per_m, 1e-9);
}

TEST(Rpe, PairsAsASearchOverAllInstantsDoes) {
  const std::vector<PosePair> pairs = RandomPairs(300, 0.02);
  double sum_m2 = 0.0;
  std::size_t count = 0;
  std::vector<double> path_m{0.0};
  for (std::size_t i = 1; i < pairs.size(); ++i)
    path_m.push_back(path_m.back() +
                     (pairs[i].T_world_base.translation() - pairs[i - 1].T_world_base.translation()).norm());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    std::size_t best = i;
    double best_m = HUGE_VAL;
    for (std::size_t j = i + 1; j < pairs.size(); ++j) {
      const double error_m = std::abs(path_m[j] - path_m[i] - 1.0);
      if (error_m < best_m) {
        best = j;
        best_m = error_m;
      }
    }
    if (best_m > 0.1) continue;
    const Pose Q = pairs[i].T_world_base.inverse() * pairs[best].T_world_base;
    const Pose P = pairs[i].T_map_base.inverse() * pairs[best].T_map_base;
    sum_m2 += (Q.inverse() * P).translation().squaredNorm();
    ++count;
  }
  const Rpe rpe = *RpeOverOneMetre(pairs);
  EXPECT_GT(count, 200u);
  EXPECT_EQ(rpe.pairs, count);
  EXPECT_NEAR(rpe.translation_percent, 100.0 * std::sqrt(sum_m2 / static_cast<double>(count)), 1e-9);
}

TEST(Rpe, IsNothingWithoutAMetreOfPath) {
  EXPECT_FALSE(RpeOverOneMetre({}));
  EXPECT_FALSE(RpeOverOneMetre(std::vector<PosePair>(1)));
  EXPECT_FALSE(RpeOverOneMetre(std::vector<PosePair>(100)));  // standing
  EXPECT_FALSE(RpeOverOneMetre(std::vector<PosePair>{{At(0, 0, 0), At(0, 0, 0)}, {At(0.85, 0, 0), At(0.85, 0, 0)}}));
  EXPECT_FALSE(RpeOverOneMetre(std::vector<PosePair>{{At(0, 0, 0), At(0, 0, 0)}, {At(1.15, 0, 0), At(1.15, 0, 0)}}));
}

TEST(PathLength, SumsTheSteps) {
  EXPECT_EQ(PathLength_m({}), 0.0);
  EXPECT_EQ(PathLength_m({{Time(0), At(1, 1, 1)}}), 0.0);
  EXPECT_EQ(PathLength_m({{Time(0), At(0, 0, 0)}, {Time(1), At(3, 4, 0)}, {Time(2), At(0, 0, 0)}}), 10.0);
}

std::vector<PosePair> RealPairs() {
  const auto read = [](const std::string& name) {
    std::stringstream text;
    text << std::ifstream(SharedData("trajectories") / name).rdbuf();
    return ParseTum(text.str(), name).trajectory;
  };
  return PairAtNearestStamps(read("freiburg1_xyz-groundtruth.txt"), read("freiburg1_xyz-rgbdslam.txt"),
                             std::chrono::milliseconds(20));
}

// The TUM RGB-D benchmark's freiburg1_xyz and an RGB-D SLAM estimate of it; expected figures by evo 1.38.1.
TEST(Ate, AgreesWithEvoOnARealTrajectory) {
  const std::filesystem::path folder = SharedData("trajectories");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real trajectories: " << folder << " does not exist";
  const std::vector<PosePair> pairs = RealPairs();
  ASSERT_EQ(pairs.size(), 786u);
  EXPECT_NEAR(AlignAndAte(pairs)->rmse_m, 0.013473468, 1e-9);
  const Rpe rpe = *RpeOverOneMetre(pairs);
  EXPECT_EQ(rpe.pairs, 650u);
  EXPECT_NEAR(rpe.translation_percent, 1.776368532, 1e-6);
  EXPECT_NEAR(rpe.rotation_deg_per_m, 0.818638863, 1e-6);
}

}  // namespace
}  // namespace merlin
