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
};

template <class Visitor>
void Visit(Visitor& v, OptimizeConfig& c) {
  v("iterations_max", c.iterations_max, {0.0, 1e6});
  v("improvement_min", c.improvement_min, {0.0, 1.0});
}

struct OptimizeResult {
  std::vector<Pose> poses{};  // T_map_pose; fixed ones unchanged
  double objective = 0.0;     // their value
  int iterations = 0;
  bool converged = false;  // false: the last iterate, no worse than the start
};

// Starts at the graph's poses. stop: checked before each iteration. A graph without edges, or with numbers that are not
// finite, keeps its poses. Throws MachineError where the equations would not fit into memory.
OptimizeResult Optimize(const PoseGraph& graph, const OptimizeConfig& config, Objective objective = Objective::kB,
                        const std::atomic<bool>* stop = nullptr);

}  // namespace merlin
