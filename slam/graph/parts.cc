#include "slam/graph/parts.h"

#include <limits>
#include <numeric>

namespace merlin {
namespace {

// A number per pose, equal for poses that are joined by a chain of edges (union-find).
std::vector<std::size_t> Roots(const PoseGraph& graph) {
  std::vector<std::size_t> parent(graph.poses.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&parent](std::size_t i) {
    for (; parent[i] != i; i = parent[i]) parent[i] = parent[parent[i]];
    return i;
  };
  for (const GraphEdge& edge : graph.edges) parent[root(edge.from)] = root(edge.to);
  std::vector<std::size_t> roots(parent.size());
  for (std::size_t i = 0; i < roots.size(); ++i) roots[i] = root(i);
  return roots;
}

}  // namespace

std::vector<GraphPart> PartsOf(const PoseGraph& graph) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  const std::vector<std::size_t> roots = Roots(graph);
  std::vector<GraphPart> parts;
  std::vector<std::size_t> part_of_root(roots.size(), kNone), index_in_part(roots.size());
  for (std::size_t i = 0; i < roots.size(); ++i) {
    std::size_t& number = part_of_root[roots[i]];
    if (number == kNone) {
      number = parts.size();
      parts.emplace_back().graph.planar = graph.planar;
    }
    GraphPart& part = parts[number];
    index_in_part[i] = part.poses.size();
    part.poses.push_back(i);
    part.graph.poses.push_back(graph.poses[i]);
  }
  const auto part_with = [&](std::size_t pose) -> PoseGraph& { return parts[part_of_root[roots[pose]]].graph; };
  for (GraphEdge edge : graph.edges) {
    PoseGraph& part = part_with(edge.from);
    edge.from = index_in_part[edge.from];
    edge.to = index_in_part[edge.to];
    part.edges.push_back(edge);
  }
  for (const std::size_t pose : graph.fixed) part_with(pose).fixed.push_back(index_in_part[pose]);
  return parts;
}

void PutPoses(const GraphPart& part, PoseGraph& whole) {
  for (std::size_t i = 0; i < part.poses.size(); ++i) whole.poses[part.poses[i]] = part.graph.poses[i];
}

}  // namespace merlin
