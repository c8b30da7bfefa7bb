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

// Starts at the graph's poses. stop: checked before each iteration. A graph without edges, or whose numbers are not finite, is returned as it came. Throws MachineError where
// the equations would not fit into memory.
OptimizeResult Optimize(const PoseGraph& graph, const OptimizeConfig& config, Objective objective = Objective::kB,
                        const std::atomic<bool>* stop = nullptr);

}  // namespace merlin
