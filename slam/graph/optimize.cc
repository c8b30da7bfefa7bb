#include "slam/graph/optimize.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "robot/types/error.h"
#include "slam/graph/block_cholesky.h"
#include "slam/graph/free_poses.h"

namespace merlin {
namespace {

constexpr double kFirstDamping = 1e-12, kDampingFactor = 10.0;  // guesses; of H's diagonal
constexpr double kDampingMax = 1e12;                           // beyond it a step moves nothing
constexpr double kFactor_bytes_max = 4e9;

struct Robust {
  double cost = 0.0, weight = 1.0;  // and the cost's derivative by chi2
};

// The cost whose derivative is s^2: Agarwal et al. eq. 15 gives s; integrated from phi on.
Robust ScaledCovariance(double chi2, double phi) {
  if (chi2 <= phi) return {.cost = chi2};
  const double s = 2.0 * phi / (phi + chi2);
  return {.cost = phi * (3.0 * chi2 - phi) / (chi2 + phi), .weight = s * s};
}

template <class Group>
class Problem {
 public:
  using State = typename Group::State;
  using Matrix = typename Group::Matrix;
  using Vector = typename Group::Vector;
  static constexpr int kSize = Group::kSize;

  Problem(const PoseGraph& graph, const OptimizeConfig& config, Objective objective)
      : graph_(graph),
        config_(config),
        rotation_(PlanarRotationIn(objective)),
        free_(graph),
        pattern_(MakePattern(free_.count, free_.pairs)),
        H_(pattern_) {
    RequireMemory();
    for (const Pose& pose : graph.poses) states_.push_back(Group::Of(pose));
    for (const GraphEdge& edge : graph.edges) {
      measured_.push_back(Group::Of(edge.T_from_to));
      information_.push_back(Group::Part(InformationIn(objective, edge, graph.planar)));
    }
  }

  OptimizeResult Solve(const std::atomic<bool>* stop) {
    OptimizeResult result;
    result.poses = graph_.poses;
    result.objective = Cost(states_);
    BlockCholesky<kSize> solver(pattern_);
    double damping = 0.0;
    if (!std::isfinite(result.objective)) return result;
    result.converged = free_.count == 0 || graph_.edges.empty();
    while (!result.converged && result.iterations < config_.iterations_max && !(stop && *stop)) {
      ++result.iterations;
      Linearize();
      if (!Improve(solver, damping, result)) break;
    }
    for (std::size_t i = 0; i < states_.size(); ++i)
      if (free_.row[i] != FreePoses::kFixed) result.poses[i] = Group::ToPose(states_[i]);
    for (std::size_t i = 0; i < graph_.edges.size(); ++i)
      result.edge_weights.push_back(RobustOf(i, Chi2(states_, i)).weight);
    return result;
  }

 private:
  void RequireMemory() const {
    const double bytes = sizeof(Matrix) * static_cast<double>(pattern_.factor_blocks());
    if (bytes > kFactor_bytes_max)
      throw MachineError("the graph's equations would take " + std::to_string(bytes * 1e-9) +
                         " GB of memory: too many edges join poses that are far apart");
  }

  double Chi2(const std::vector<State>& states, std::size_t i) const {
    const GraphEdge& edge = graph_.edges[i];
    const Vector error = Group::Error(states[edge.from], states[edge.to], measured_[i], rotation_);
    return error.dot(information_[i] * error);
  }

  Robust RobustOf(std::size_t i, double chi2) const {
    return graph_.edges[i].robust ? ScaledCovariance(chi2, config_.robust_chi2) : Robust{.cost = chi2};
  }

  double Cost(const std::vector<State>& states) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < graph_.edges.size(); ++i) sum += RobustOf(i, Chi2(states, i)).cost;
    return sum;
  }

  // H and g of cost(step) = cost + 2 g step + step H step.
  void Linearize() {
    H_.SetZero();
    g_.setZero(kSize * free_.count);
    std::size_t pair = 0;
    for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
      const GraphEdge& edge = graph_.edges[i];
      const int from = free_.row[edge.from], to = free_.row[edge.to];
      const auto linear = Group::Linearize(states_[edge.from], states_[edge.to], measured_[i], rotation_);
      const Vector weighted = information_[i] * linear.error;
      const double weight = RobustOf(i, linear.error.dot(weighted)).weight;
      const Matrix H_to = weight * linear.J_to.transpose() * (information_[i] * linear.J_to);
      const Vector g_to = weight * linear.J_to.transpose() * weighted;
      const Matrix H_from_to = -linear.adjoint.transpose() * H_to;
      if (to != FreePoses::kFixed) {
        H_.diagonal[to] += H_to;
        g_.template segment<kSize>(kSize * to) += g_to;
      }
      if (from != FreePoses::kFixed) {
        H_.diagonal[from] -= H_from_to * linear.adjoint;
        g_.template segment<kSize>(kSize * from) -= linear.adjoint.transpose() * g_to;
      }
      if (from != FreePoses::kFixed && to != FreePoses::kFixed)
        H_.AddOff(pattern_, pair++, {.row = from, .column = to}, H_from_to);
    }
  }

  // One step, damped as little as lets it improve the cost. False: there is none.
  bool Improve(BlockCholesky<kSize>& solver, double& damping, OptimizeResult& result) {
    for (; damping <= kDampingMax; damping = std::max(kFirstDamping, kDampingFactor * damping)) {
      if (!solver.Factorize(H_, damping)) continue;
      Eigen::VectorXd step = -g_;
      solver.Solve(step);
      const double expected = -g_.dot(step);  // of a whole Gauss-Newton step
      if (!step.allFinite()) continue;
      const std::vector<State> moved = Moved(step);
      const double cost = Cost(moved);
      const bool small = expected <= config_.improvement_min * result.objective + 1e-12;
      if (!(cost <= result.objective)) {
        if (!small) continue;
        result.converged = true;  // what is left to gain is less than rounding
        return true;
      }
      result.converged = small && damping <= kFirstDamping;
      states_ = moved;
      result.objective = cost;
      damping = damping > kFirstDamping ? damping / kDampingFactor : 0.0;
      return true;
    }
    return false;
  }

  std::vector<State> Moved(const Eigen::VectorXd& step) const {
    std::vector<State> moved = states_;
    for (std::size_t i = 0; i < moved.size(); ++i)
      if (free_.row[i] != FreePoses::kFixed)
        moved[i] = Group::Moved(states_[i], step.segment<kSize>(kSize * free_.row[i]));
    return moved;
  }

  const PoseGraph& graph_;
  const OptimizeConfig& config_;
  const PlanarRotation rotation_;
  const FreePoses free_;
  const BlockPattern pattern_;
  std::vector<State> states_, measured_;
  std::vector<Matrix> information_;
  BlockMatrix<kSize> H_;
  Eigen::VectorXd g_;
};

}  // namespace

OptimizeResult Optimize(const PoseGraph& graph, const OptimizeConfig& config, Objective objective,
                        const std::atomic<bool>* stop) {
  if (graph.planar) return Problem<Planar>(graph, config, objective).Solve(stop);
  return Problem<Spatial>(graph, config, objective).Solve(stop);
}

}  // namespace merlin
