#include "slam/graph/optimize.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <thread>

#include "slam/graph/initial_poses.h"
#include "tests/slam/graph/random_graph.h"

namespace merlin {
namespace {

constexpr double kPi = std::numbers::pi;

double Distance(const Pose& a, const Pose& b) { return Log(a.inverse() * b).norm(); }

void ExpectSamePoses(const std::vector<Pose>& a, const std::vector<Pose>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(Distance(a[i], b[i]), tolerance) << i;
}

// If all edges agree, every pose is found from a distant start, whatever the weights.
TEST(Optimize, FindsPosesThatAgreeWithEveryEdge) {
  for (const bool planar : {false, true}) {
    RandomGraphs random(1);
    PoseGraph graph = random.Walk(30, 0.0, planar);
    const std::vector<Pose> truth = graph.poses;
    for (std::size_t i = 1; i < graph.poses.size(); ++i)
      graph.poses[i] = graph.poses[i] * Exp(random.Tangent(0.2, 0.2, planar));
    for (const Objective objective : {Objective::kA, Objective::kB}) {
      const OptimizeResult result = Optimize(graph, {}, objective);
      EXPECT_TRUE(result.converged);
      EXPECT_LT(result.objective, 1e-18);
      ExpectSamePoses(result.poses, truth, 1e-8);
    }
  }
}

// Where no step improves, every derivative of the objective is zero: by differences of its value alone.
TEST(Optimize, EndsWhereFiniteDifferencesVanish) {
  for (const bool planar : {false, true})
    for (const Objective objective : {Objective::kA, Objective::kB}) {
      RandomGraphs random(2);
      PoseGraph graph = random.Walk(12, 0.1, planar);
      const OptimizeResult result = Optimize(graph, {}, objective);
      ASSERT_TRUE(result.converged);
      const auto value = [&](std::size_t pose, const Vector6d& step) {
        graph.poses = result.poses;
        graph.poses[pose] = graph.poses[pose] * Exp(step);
        return Evaluate(graph, objective);
      };
      EXPECT_NEAR(value(0, Vector6d::Zero()), result.objective, 1e-12 * result.objective);
      for (std::size_t pose = 1; pose < graph.poses.size(); ++pose)
        for (const int i : planar ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5}) {
          const Vector6d step = 1e-4 * Vector6d::Unit(i);
          const double slope = (value(pose, step) - value(pose, -step)) / 2e-4;
          const double curve = (value(pose, step) + value(pose, -step) - 2.0 * result.objective) / 1e-8;
          EXPECT_LT(std::abs(slope), 1e-4 * curve)
              << planar << " " << pose << " " << i;  // 0.1 mm, 0.1 mrad away at most
          EXPECT_GT(curve, 0.0);
        }
    }
}

// Lu and Milios' linear network (the thesis' eq. 5.1-5.10): with headings known, X = G^-1 B with G_ii the sum of the
// inverse covariances at i, G_ij = -C_ij^-1 and B_i the sum of C_ij^-1 D_ij.
TEST(Optimize, SolvesLuAndMiliosNetworkAroundACentralObject) {
  constexpr int kPoses = 8;
  RandomGraphs random(3);
  PoseGraph graph{.poses = {}, .edges = {}, .fixed = {}, .planar = true};
  for (int i = 0; i < kPoses; ++i) {
    const double angle_rad = 2.0 * kPi * i / kPoses;
    graph.poses.push_back(FromXyYaw(3.0 * std::cos(angle_rad) - 3.0, 3.0 * std::sin(angle_rad), 0.0));
  }
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(2 * kPoses, 2 * kPoses);
  Eigen::VectorXd B = Eigen::VectorXd::Zero(2 * kPoses);
  for (int i = 0; i < 2 * kPoses; ++i) {  // neighbours and next neighbours around the loop
    const int from = i % kPoses, to = (from + 1 + i / kPoses) % kPoses;
    Eigen::Matrix2d root;
    root << 2.0 + random.Normal(0.2), random.Normal(), random.Normal(), 3.0;
    const Eigen::Matrix2d C_inverse = root * root.transpose();  // correlated
    const Pose step = graph.poses[from].inverse() * graph.poses[to];
    const Eigen::Vector2d D = step.translation().head<2>() + Eigen::Vector2d(random.Normal(0.1), random.Normal(0.1));
    GraphEdge edge{.from = static_cast<std::size_t>(from),
                   .to = static_cast<std::size_t>(to),
                   .T_from_to = FromXyYaw(D.x(), D.y(), 0.0)};
    edge.information = 1e9 * Matrix6d::Identity();  // the heading, known
    edge.information.topLeftCorner<2, 2>() = C_inverse;
    graph.edges.push_back(edge);
    G.block<2, 2>(2 * from, 2 * from) += C_inverse;
    G.block<2, 2>(2 * to, 2 * to) += C_inverse;
    G.block<2, 2>(2 * from, 2 * to) -= C_inverse;
    G.block<2, 2>(2 * to, 2 * from) -= C_inverse;
    B.segment<2>(2 * to) += C_inverse * D;
    B.segment<2>(2 * from) -= C_inverse * D;
  }
  const Eigen::VectorXd X = G.bottomRightCorner(2 * kPoses - 2, 2 * kPoses - 2).ldlt().solve(B.tail(2 * kPoses - 2));
  const OptimizeResult result = Optimize(graph, {});
  EXPECT_TRUE(result.converged);
  for (int i = 1; i < kPoses; ++i)
    EXPECT_LT((result.poses[i].translation().head<2>() - X.segment<2>(2 * i - 2)).norm(), 1e-6) << i;
}

// Two measurements of one small motion: the mean weighted by their whole, correlated information.
TEST(Optimize, WeighsByTheWholeInformationMatrix) {
  RandomGraphs random(4);
  const Vector6d a = random.Tangent(1e-5, 1e-5), b = random.Tangent(1e-5, 1e-5);
  const Matrix6d I_a = random.Information(), I_b = random.Information();
  PoseGraph graph{.poses = {Pose::Identity(), Pose::Identity()}, .edges = {}, .fixed = {}, .planar = false};
  graph.edges.push_back({.from = 0, .to = 1, .T_from_to = Exp(a), .information = I_a});
  graph.edges.push_back({.from = 0, .to = 1, .T_from_to = Exp(b), .information = I_b});
  const Vector6d mean = (I_a + I_b).ldlt().solve(I_a * a + I_b * b);
  EXPECT_LT((Log(Optimize(graph, {}).poses[1]) - mean).norm(), 1e-8);
}

// A chain and its closure with equal weights share the misfit equally, also where the yaw passes pi.
TEST(Optimize, SharesAMisfitEquallyAcrossHalfATurn) {
  PoseGraph graph{.poses = {}, .edges = {}, .fixed = {}, .planar = true};
  for (int i = 0; i < 9; ++i) graph.poses.push_back(FromXyYaw(0.0, 0.0, 0.8 * i));
  for (std::size_t i = 0; i < 8; ++i)
    graph.edges.push_back({.from = i, .to = i + 1, .T_from_to = FromXyYaw(0.0, 0.0, 0.8)});
  graph.edges.push_back({.from = 8, .to = 0, .T_from_to = FromXyYaw(0.0, 0.0, 2.0 * kPi - 6.4 + 0.09)});
  const OptimizeResult result = Optimize(graph, {});
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(WrapPi(Yaw(result.poses[i]) - (0.8 - 0.01) * i), 0.0, 1e-9) << i;
  EXPECT_NEAR(result.objective, 9 * 0.01 * 0.01, 1e-12);
}

TEST(Optimize, KeepsFixedPosesAndTheFirstWhereNoneIs) {
  RandomGraphs random(5);
  PoseGraph graph = random.Walk(10, 0.2, false);
  EXPECT_EQ(Optimize(graph, {}).poses[0].matrix(), graph.poses[0].matrix());
  graph.fixed = {3, 7};
  const OptimizeResult result = Optimize(graph, {});
  for (const std::size_t pose : graph.fixed) EXPECT_EQ(result.poses[pose].matrix(), graph.poses[pose].matrix());
  EXPECT_GT(Distance(result.poses[0], graph.poses[0]), 1e-3);
}

TEST(Optimize, LeavesUnconstrainedPosesUnchanged) {
  EXPECT_TRUE(Optimize({}, {}).converged);
  PoseGraph graph{.poses = {Exp(Vector6d::Ones())}, .edges = {}, .fixed = {}, .planar = false};
  EXPECT_EQ(Optimize(graph, {}).poses[0].matrix(), graph.poses[0].matrix());
  graph.poses.push_back(Pose::Identity());
  EXPECT_TRUE(Optimize(graph, {}).converged);  // two poses, no edge
  graph.edges.push_back({.from = 0, .to = 1, .information = Matrix6d::Zero()});
  EXPECT_LT(Distance(Optimize(graph, {}).poses[1], Pose::Identity()), 1e-12);  // nor does one without weight move it
}

TEST(Optimize, ReturnsInputThatIsNotFiniteUnchanged) {
  RandomGraphs random(6);
  PoseGraph graph = random.Walk(5, 0.1, false);
  graph.edges[2].T_from_to.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const OptimizeResult result = Optimize(graph, {});
  EXPECT_FALSE(result.converged);
  for (std::size_t i = 0; i < graph.poses.size(); ++i) EXPECT_EQ(result.poses[i].matrix(), graph.poses[i].matrix());
}

TEST(Optimize, IsNoWorseThanItsStartAfterTooFewIterations) {
  RandomGraphs random(7);
  PoseGraph graph = random.Walk(40, 0.3, false);
  for (Pose& pose : graph.poses) pose = Exp(random.Tangent(1.0, 1.0));
  double last = Evaluate(graph, Objective::kB);
  for (const int iterations : {0, 1, 2, 5}) {
    const OptimizeResult result = Optimize(graph, {.iterations_max = iterations});
    EXPECT_LE(result.iterations, iterations);
    EXPECT_LE(result.objective, last);
    last = result.objective;
  }
  const std::atomic<bool> stop{true};
  EXPECT_EQ(Optimize(graph, {}, Objective::kB, &stop).iterations, 0);
}

TEST(Optimize, GivesTheSameBitsAgainAndInAnyThread) {
  RandomGraphs random(8);
  const PoseGraph graph = random.Walk(60, 0.1, false);
  const OptimizeResult here = Optimize(graph, {});
  std::vector<OptimizeResult> there(4);
  std::vector<std::thread> threads;
  for (OptimizeResult& result : there) threads.emplace_back([&] { result = Optimize(graph, {}); });
  for (std::thread& thread : threads) thread.join();
  for (const OptimizeResult& result : there) {
    EXPECT_EQ(result.objective, here.objective);
    for (std::size_t i = 0; i < graph.poses.size(); ++i) EXPECT_EQ(result.poses[i].matrix(), here.poses[i].matrix());
  }
}

// Two laps of a square of 10 m by drifting odometry, whose loop closures say the truth to 2 cm and 10 mrad.
struct Laps {
  PoseGraph graph;
  std::vector<Pose> truth;
};

Laps DriveTwoLaps(RandomGraphs& random) {
  constexpr std::size_t kLap = 40;
  Laps laps;
  laps.truth = {Pose::Identity()};
  const auto information = [](double sigma_m, double sigma_rad) {
    Vector6d weights;
    weights << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
        Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
    return Matrix6d(weights.asDiagonal());
  };
  const auto measure = [&](std::size_t from, std::size_t to, double sigma_m, double sigma_rad) {
    laps.graph.edges.push_back(
        {.from = from,
         .to = to,
         .T_from_to = laps.truth[from].inverse() * laps.truth[to] * Exp(random.Tangent(sigma_m, sigma_rad)),
         .information = information(sigma_m, sigma_rad)});
  };
  for (std::size_t i = 1; i <= 2 * kLap; ++i)
    laps.truth.push_back(laps.truth.back() * FromXyYaw(1.0, 0.0, i % 10 == 0 ? kPi / 2 : 0.0));
  laps.graph.poses.resize(laps.truth.size(), Pose::Identity());
  for (std::size_t i = 0; i < 2 * kLap; ++i) measure(i, i + 1, 0.03, 0.01);
  for (std::size_t i = 0; i <= kLap; i += 8) {
    measure(i, i + kLap, 0.02, 0.01);
    laps.graph.edges.back().robust = true;
  }
  laps.graph.poses = ChainedPoses(laps.graph);
  return laps;
}

double WorstError_m(const std::vector<Pose>& poses, const std::vector<Pose>& truth) {
  double worst_m = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    worst_m = std::max(worst_m, (poses[i].translation() - truth[i].translation()).norm());
  return worst_m;
}

TEST(RobustEdges, KeepRightLoopsAndDropAWrongOne) {
  for (const unsigned seed : {1u, 2u, 10u, 15u, 19u}) {  // of the latter three one descent alone drops a right loop
    RandomGraphs random(seed);
    Laps laps = DriveTwoLaps(random);
    const OptimizeResult right = Optimize(laps.graph, {});
    EXPECT_TRUE(right.converged);
    for (std::size_t i = 0; i < laps.graph.edges.size(); ++i) EXPECT_GT(right.edge_weights[i], 0.5) << seed << " " << i;
    EXPECT_LT(WorstError_m(right.poses, laps.truth), WorstError_m(laps.graph.poses, laps.truth));

    GraphEdge wrong = laps.graph.edges.back();  // two corridors that look alike
    wrong.from = 5;
    wrong.to = 5 + 40 + 20;
    wrong.T_from_to = Pose::Identity();
    wrong.robust = true;
    laps.graph.edges.push_back(wrong);
    const OptimizeResult robust = Optimize(laps.graph, {});
    EXPECT_LT(robust.edge_weights.back(), 0.01) << seed;
    for (std::size_t i = 0; i < robust.poses.size(); ++i)
      EXPECT_LT((robust.poses[i].translation() - right.poses[i].translation()).norm(), 0.1) << seed << " " << i;

    laps.graph.edges.back().robust = false;
    EXPECT_GT(WorstError_m(Optimize(laps.graph, {}).poses, laps.truth), 3.0) << seed;
  }
}

// The cost of a robust edge is the integral of its weight over chi2.
TEST(RobustEdges, CostWhatTheirWeightSumsUpTo) {
  double cost = 0.0;
  constexpr double kStep = 1e-3;
  OptimizeConfig config{.iterations_max = 0};
  const auto at = [&config](double chi2) {
    PoseGraph graph{.poses = {Pose::Identity(), FromXyYaw(std::sqrt(chi2), 0.0, 0.0)},
                    .edges = {{.from = 0, .to = 1}},
                    .fixed = {},
                    .planar = true};
    graph.edges[0].robust = true;
    return Optimize(graph, config);
  };
  for (double chi2 = 0.0; chi2 < 40.0; chi2 += kStep) cost += kStep * at(chi2 + 0.5 * kStep).edge_weights[0];
  EXPECT_NEAR(at(40.0).objective, cost, 1e-3);
  EXPECT_EQ(at(12.5).objective, at(12.5).objective);
  EXPECT_NEAR(at(12.5).objective, 12.5, 1e-12);
  EXPECT_NEAR(at(3 * 12.6).edge_weights[0], 0.25, 1e-12);
}

}  // namespace
}  // namespace merlin
