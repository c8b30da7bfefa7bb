// The poses that agree best with a graph's edges: Gauss-Newton on the poses' manifold, damped (Levenberg, Marquardt)
// where a whole step would not improve, analytic derivatives, sparse Cholesky. One thread: the same bits for the same
// input.
#pragma once

#include <atomic>
#include <vector>

#include "robot/base/config.h"
#include "slam/graph/objective.h"
#include "slam/graph/pose_graph.h"

namespace merlin {

struct OptimizeConfig {
  int iterations_max = 100;        // [0, 1e6]
  double improvement_min = 1e-10;  // [0, 1] share of the objective; a step expected to improve it by less ends it
  // [1e-6, 1e12] chi2 from which an edge marked robust loses weight: that of 95 % of right ones with 6 degrees of
  // freedom.
  double robust_chi2 = 12.6;
};

template <class Visitor>
void Visit(Visitor& v, OptimizeConfig& c) {
  v("iterations_max", c.iterations_max, {0.0, 1e6});
  v("improvement_min", c.improvement_min, {0.0, 1.0});
  v("robust_chi2", c.robust_chi2, {1e-6, 1e12});
}

struct OptimizeResult {
  std::vector<Pose> poses{};  // T_map_pose; fixed ones unchanged
  double objective = 0.0;     // robust edges at their robust cost
  int iterations = 0;
  bool converged = false;              // false: the last iterate, no worse than the start
  std::vector<double> edge_weights{};  // of each edge at the end: 1, or of a robust one that disagrees less, down to 0
};

// Starts at the graph's poses. Robust edges: dynamic covariance scaling (P. Agarwal et al., "Robust map optimization
// using dynamic covariance scaling", ICRA 2013): s = min(1, 2 phi / (phi + chi2)), weight s^2; where some end without
// weight, a second descent lets them go by and by, and the better of both counts. stop: looked at before each
// iteration. A graph without edges, or whose numbers are not finite, is returned as it came. Throws MachineError where
// the equations would not fit into memory.
OptimizeResult Optimize(const PoseGraph& graph, const OptimizeConfig& config, Objective objective = Objective::kB,
                        const std::atomic<bool>* stop = nullptr);

}  // namespace merlin
