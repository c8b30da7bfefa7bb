// Splits a graph into its connected components. Each is a problem of its own.
#pragma once

#include <cstddef>
#include <vector>

#include "slam/graph/pose_graph.h"

namespace merlin {

struct GraphPart {
  PoseGraph graph{};                 // with the fixed poses that lie in this part
  std::vector<std::size_t> poses{};  // their indices in the whole graph, ascending
};

// The parts in the order of their first poses; poses and edges keep their order. A pose without edges is a part of its
// own.
std::vector<GraphPart> PartsOf(const PoseGraph& graph);

// Copies the part's poses into the whole graph.
void PutPoses(const GraphPart& part, PoseGraph& whole);

}  // namespace merlin
