#include "slam/graph/optimize.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "robot/base/error.h"
#include "slam/graph/block_cholesky.h"
#include "slam/graph/free_poses.h"

namespace merlin {
namespace {

constexpr double kFirstDamping = 1e-12, kDampingFactor = 10.0;  // shares of H's diagonal; guesses
constexpr double kDampingMax = 1e12;                            // beyond it a step moves no pose
constexpr double kConvergedDamping = 1e-6;                      // beyond it a small step does not mean convergence
constexpr double kGraduation = 4.0;                             // of robust_chi2, from one descent to the next; guess
constexpr int kIterationsAGrade = 2;                            // guess
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
class GraphProblem {
 public:
  using State = typename Group::State;
  using Matrix = typename Group::Matrix;
  using Vector = typename Group::Vector;
  static constexpr int kSize = Group::kSize;

  GraphProblem(const PoseGraph& graph, const OptimizeConfig& config, Objective objective)
      : graph_(graph),
        config_(config),
        rotation_(PlanarRotationIn(objective)),
        free_(graph),
        pattern_(MakePattern(free_.count, free_.pairs)),
        H_(pattern_),
        solver_(Allowed(pattern_)) {
    for (const Pose& pose : graph.poses) states_.push_back(Group::Of(pose));
    for (const GraphEdge& edge : graph.edges) {
      measured_.push_back(Group::Of(edge.T_from_to));
      information_.push_back(Group::Part(InformationIn(objective, edge, graph.planar)));
    }
  }

  OptimizeResult Solve(const std::atomic<bool>* stop) {
    stop_ = stop;
    OptimizeResult result;
    result.poses = graph_.poses;
    result.objective = Cost(states_);
    if (!std::isfinite(result.objective)) return result;
    const std::vector<State> start = states_;
    Ending end = Descend(config_.iterations_max);
    if (WorstRobustChi2(end.states) > phi_) {
      const Ending other = DescendGradually(start);
      if (other.cost < end.cost) end = other;
    }
    for (std::size_t i = 0; i < end.states.size(); ++i)
      if (free_.row[i] != FreePoses::kFixed) result.poses[i] = Group::ToPose(end.states[i]);
    for (std::size_t i = 0; i < graph_.edges.size(); ++i)
      result.edge_weights.push_back(RobustOf(i, Chi2(end.states, i)).weight);
    result.objective = end.cost;
    result.converged = end.converged;
    result.iterations = iterations_;
    return result;
  }

 private:
  struct Ending {
    std::vector<State> states;
    double cost = 0.0;
    bool converged = false;
  };

  // Starts at states_.
  Ending Descend(int iterations) {
    cost_ = Cost(states_);
    bool converged = free_.count == 0 || graph_.edges.empty();
    double damping = 0.0;
    for (; iterations > 0 && !converged && iterations_ < config_.iterations_max && !(stop_ && *stop_); --iterations) {
      ++iterations_;
      Linearize();
      if (!Improve(damping, converged)) break;
    }
    return {.states = states_, .cost = cost_, .converged = converged};
  }

  // Robust edges hold in full at first, and are let go step by step (A. Blake and A. Zisserman, "Visual reconstruction",
  // 1987: graduated non-convexity): odometry may have drifted so far that right loops look wrong at the start.
  Ending DescendGradually(const std::vector<State>& start) {
    states_ = start;
    for (phi_ = WorstRobustChi2(start); phi_ > config_.robust_chi2; phi_ /= kGraduation) Descend(kIterationsAGrade);
    phi_ = config_.robust_chi2;
    return Descend(config_.iterations_max);
  }

  double WorstRobustChi2(const std::vector<State>& states) const {
    double worst = 0.0;
    for (std::size_t i = 0; i < graph_.edges.size(); ++i)
      if (graph_.edges[i].robust) worst = std::max(worst, Chi2(states, i));
    return worst;
  }

  static const BlockPattern& Allowed(const BlockPattern& pattern) {
    const double bytes = sizeof(Matrix) * static_cast<double>(pattern.factor_blocks());
    if (bytes > kFactor_bytes_max)
      throw MachineError("the graph's equations would take " + std::to_string(bytes * 1e-9) +
                         " GB of memory: too many edges join poses that are far apart");
    return pattern;
  }

  double Chi2(const std::vector<State>& states, std::size_t i) const {
    const GraphEdge& edge = graph_.edges[i];
    const Vector error = Group::Error(states[edge.from], states[edge.to], measured_[i], rotation_);
    return error.dot(information_[i] * error);
  }

  Robust RobustOf(std::size_t i, double chi2) const {
    return graph_.edges[i].robust ? ScaledCovariance(chi2, phi_) : Robust{.cost = chi2};
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
    for (Matrix& block : H_.diagonal)  // a coordinate without weight in any edge stays
      for (double& value : block.diagonal())
        if (!(value > 0.0)) value = 1.0;
  }

  // One step, with the least damping that improves the cost. False: no damping does.
  bool Improve(double& damping, bool& converged) {
    for (; damping <= kDampingMax; damping = std::max(kFirstDamping, kDampingFactor * damping)) {
      if (!solver_.Factorize(H_, damping)) continue;
      Eigen::VectorXd step = -g_;
      solver_.Solve(step);
      const double expected = -g_.dot(step);  // of a whole Gauss-Newton step
      if (!step.allFinite()) continue;
      const std::vector<State> moved = Moved(step);
      const double cost = Cost(moved);
      const bool small = expected <= config_.improvement_min * cost_ + 1e-12;
      if (!(cost <= cost_)) {
        if (!small) continue;
        converged = true;  // a further gain would be less than rounding
        return true;
      }
      converged = small && damping <= kConvergedDamping;
      states_ = moved;
      cost_ = cost;
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
  BlockCholesky<kSize> solver_;
  Eigen::VectorXd g_;
  double phi_ = config_.robust_chi2, cost_ = 0.0;
  int iterations_ = 0;
  const std::atomic<bool>* stop_ = nullptr;
};

}  // namespace

OptimizeResult Optimize(const PoseGraph& graph, const OptimizeConfig& config, Objective objective,
                        const std::atomic<bool>* stop) {
  if (graph.planar) return GraphProblem<Planar>(graph, config, objective).Solve(stop);
  return GraphProblem<Spatial>(graph, config, objective).Solve(stop);
}

}  // namespace merlin
