// Finds the poses that agree best with the edges of a graph: Gauss-Newton on the manifold of the poses, with analytic
// derivatives and a sparse Cholesky factorisation. Where a whole step would not improve the objective it is damped, as
// by Levenberg and Marquardt (J. Nocedal and S. Wright, "Numerical optimization", 2006, section 10.3). It uses one
// thread, and gives the same bits for the same input.
#pragma once

#include <atomic>
#include <vector>

#include "robot/base/config.h"
#include "slam/graph/objective.h"
#include "slam/graph/pose_graph.h"

namespace merlin {

struct OptimizeConfig {
  int iterations_max = 100;        // [0, 1e6]
  double improvement_min = 1e-10;  // [0, 1] share of the objective; ends where a step is expected to improve it by less
  // [1e-6, 1e12] chi2 from which a robust edge loses weight: 95 % of the right ones with 6 degrees of freedom lie below
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
// using dynamic covariance scaling", ICRA 2013): s = min(1, 2 phi / (phi + chi2)), weight s^2. Where some end without
// weight, a second descent lets them go step by step, and the better of both counts. stop: checked before each iteration.
// A graph without edges, or with numbers that are not finite, keeps its poses. Throws MachineError where the equations
// would not fit into memory.
OptimizeResult Optimize(const PoseGraph& graph, const OptimizeConfig& config, Objective objective = Objective::kB,
                        const std::atomic<bool>* stop = nullptr);

}  // namespace merlin
