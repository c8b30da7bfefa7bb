#include "slam/graph/initial_poses.h"

#include <Eigen/SVD>
#include <array>
#include <functional>
#include <queue>
#include <utility>

#include "slam/graph/block_cholesky.h"
#include "slam/graph/free_poses.h"
#include "slam/graph/objective.h"

namespace merlin {
namespace {

constexpr int kFixed = FreePoses::kFixed;

// The rotation nearest to M in the Frobenius norm.
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& M) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

// Least squares with one block of unknowns per pose: sum of weight |x_to - M x_from - c|^2, M orthogonal.
template <int D>
class LinearNetwork {
 public:
  using Block = Eigen::Matrix<double, D, D>;
  using Value = Eigen::Matrix<double, D, 3>;

  LinearNetwork(const FreePoses& free, const BlockPattern& pattern)
      : free_(free), pattern_(pattern), A_(pattern), b_(Eigen::MatrixXd::Zero(D * free.count, 3)) {}

  // x_from and x_to are used where the pose is fixed.
  void Add(const GraphEdge& edge, double weight, const Block& M, const Value& c, const Value& x_from,
           const Value& x_to) {
    const int from = free_.row[edge.from], to = free_.row[edge.to];
    if (from != kFixed) {
      A_.diagonal[from].diagonal().array() += weight;
      b_.middleRows<D>(D * from) += weight * M.transpose() * (to == kFixed ? Value(x_to - c) : Value(-c));
    }
    if (to != kFixed) {
      A_.diagonal[to].diagonal().array() += weight;
      b_.middleRows<D>(D * to) += weight * (from == kFixed ? Value(M * x_from + c) : c);
    }
    if (from != kFixed && to != kFixed)
      A_.AddOff(pattern_, pair_++, {.row = from, .column = to}, -weight * M.transpose());
  }

  std::optional<Eigen::MatrixXd> Solve() {
    BlockCholesky<D> solver(pattern_);
    if (!solver.Factorize(A_, 0.0)) return std::nullopt;
    solver.Solve(b_);
    return std::move(b_);
  }

 private:
  const FreePoses& free_;
  const BlockPattern& pattern_;
  BlockMatrix<D> A_;
  Eigen::MatrixXd b_;
  std::size_t pair_ = 0;
};

}  // namespace

std::vector<Pose> ChainedPoses(const PoseGraph& graph) {
  std::vector<Pose> poses = graph.poses;
  std::vector<std::vector<std::size_t>> edges_of(poses.size());
  for (std::size_t i = 0; i < graph.edges.size(); ++i)
    for (const std::size_t end : {graph.edges[i].from, graph.edges[i].to}) edges_of[end].push_back(i);

  std::vector<bool> reached(poses.size(), false);
  using Candidate = std::array<std::size_t, 2>;  // gap of indices, edge
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates;
  const auto reach = [&](std::size_t pose) {
    reached[pose] = true;
    for (const std::size_t i : edges_of[pose]) {
      const auto [low, high] = std::minmax(graph.edges[i].from, graph.edges[i].to);
      candidates.push({high - low, i});
    }
  };
  const FreePoses free(graph);
  for (std::size_t pose = 0; pose < poses.size(); ++pose)
    if (free.row[pose] == kFixed) reach(pose);
  while (!candidates.empty()) {
    const GraphEdge& edge = graph.edges[candidates.top()[1]];
    candidates.pop();
    if (reached[edge.from] && reached[edge.to]) continue;
    const bool forward = reached[edge.from];
    if (forward)
      poses[edge.to] = poses[edge.from] * edge.T_from_to;
    else
      poses[edge.from] = poses[edge.to] * edge.T_from_to.inverse();
    reach(forward ? edge.to : edge.from);
  }
  return poses;
}

std::optional<std::vector<Pose>> ChordalPoses(const PoseGraph& graph) {
  const FreePoses free(graph);
  const BlockPattern pattern = MakePattern(free.count, free.pairs);

  // The unknowns are R^T of each pose: the rows of R_to - R_from R_from_to are independent.
  LinearNetwork<3> rotations(free, pattern);
  LinearNetwork<1> translations(free, pattern);
  std::vector<IsotropicWeights> weights;
  for (const GraphEdge& edge : graph.edges) {
    weights.push_back(WeightsInA(edge, graph.planar));
    rotations.Add(edge, weights.back().kappa, edge.T_from_to.linear().transpose(), Eigen::Matrix3d::Zero(),
                  graph.poses[edge.from].linear().transpose(), graph.poses[edge.to].linear().transpose());
  }
  const std::optional<Eigen::MatrixXd> turned = rotations.Solve();
  if (!turned) return std::nullopt;
  std::vector<Pose> poses = graph.poses;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (free.row[i] != kFixed) poses[i].linear() = NearestRotation(turned->middleRows<3>(3 * free.row[i]).transpose());

  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const GraphEdge& edge = graph.edges[i];
    const Eigen::RowVector3d step = (poses[edge.from].linear() * edge.T_from_to.translation()).transpose();
    translations.Add(edge, weights[i].tau, Eigen::Matrix<double, 1, 1>::Identity(), step,
                     poses[edge.from].translation().transpose(), poses[edge.to].translation().transpose());
  }
  const std::optional<Eigen::MatrixXd> moved = translations.Solve();
  if (!moved) return std::nullopt;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (free.row[i] != kFixed) poses[i].translation() = moved->row(free.row[i]).transpose();
  return poses;
}

}  // namespace merlin
