// A graph in which no chain of edges joins some poses to others: each part is a problem of its own.
#pragma once

#include <cstddef>
#include <vector>

#include "slam/graph/pose_graph.h"

namespace merlin {

struct GraphPart {
  PoseGraph graph{};                 // fixed: the part's own; empty: its first pose, as everywhere
  std::vector<std::size_t> poses{};  // their indices in the whole graph, ascending
};

// The parts by their first pose, poses and edges in the whole graph's order. A pose without any edge is a part.
std::vector<GraphPart> PartsOf(const PoseGraph& graph);

// Copies the part's poses into the whole graph.
void PutPoses(const GraphPart& part, PoseGraph& whole);

}  // namespace merlin
