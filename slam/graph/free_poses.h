// Numbers the poses of a graph that may move, and collects the edges that join two of them.
#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

#include "slam/graph/block_cholesky.h"
#include "slam/graph/pose_graph.h"

namespace merlin {

struct FreePoses {
  static constexpr int kFixed = -1;
  int count = 0;
  std::vector<int> row;           // of each pose, or kFixed
  std::vector<BlockIndex> pairs;  // of edges between free poses, in the edges' order

  explicit FreePoses(const PoseGraph& graph) : row(graph.poses.size(), 0) {
    if (graph.fixed.empty() && !row.empty()) row.front() = kFixed;
    for (const std::size_t pose : graph.fixed) row[pose] = kFixed;
    for (int& value : row)
      if (value != kFixed) value = count++;
    for (const GraphEdge& edge : graph.edges) {
      assert(edge.from != edge.to && edge.from < row.size() && edge.to < row.size());
      if (row[edge.from] != kFixed && row[edge.to] != kFixed)
        pairs.push_back({.row = row[edge.from], .column = row[edge.to]});
    }
  }
};

}  // namespace merlin
