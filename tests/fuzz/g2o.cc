// Text of g2o files: it is rejected, each fault in one sentence, or accepted completely, as a graph without gaps, which
// can be written and read again.
#include <algorithm>
#include <functional>

#include "slam/graph/g2o_file.h"
#include "tests/fuzz/text.h"

namespace merlin {
namespace {

constexpr char kPlanar[] =
    "VERTEX_SE2 10 0 0 0\nVERTEX_SE2 30 1 1 1.5\nVERTEX_SE2 20 1 0 0\nFIX 20\n"
    "EDGE_SE2 10 20 1 0 0 11 12 13 22 23 33\nEDGE_SE2 20 30 0 1 1.5 5 0 0 5 0 5\n";
constexpr char kSpatial[] =
    "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 2 3 0 0 0.6 0.8\n"
    "EDGE_SE3:QUAT 0 1 1 2 3 0 0 0.6 0.8 1 2 3 4 5 6 20 7 8 9 10 30 11 12 13 40 14 15 50 16 60\n";
constexpr char kEdges[] = "# no poses\nEDGE_SE2 5 6 1 0 1.5 1 0 0 1 0 1\nEDGE_SE2 6 7 1 0 0 1 0 0 1 0 1\nFIX 6\n";

void Check(std::string_view text) {
  const auto file = fuzz::TakenOrRefused(ParseG2o, text);
  if (!file) return;
  const PoseGraph& graph = file->graph;
  fuzz::Expect(!graph.edges.empty() && file->ids.size() == graph.poses.size(), "there are edges, and an id a pose");
  fuzz::Expect(std::ranges::adjacent_find(file->ids, std::greater_equal()) == file->ids.end(), "ids ascend");
  for (const Pose& pose : graph.poses) fuzz::Expect(pose.matrix().allFinite(), "poses are finite");
  for (const std::size_t fixed : graph.fixed) fuzz::Expect(fixed < graph.poses.size(), "the fixed are poses");
  for (const GraphEdge& edge : graph.edges) {
    fuzz::Expect(edge.from < graph.poses.size() && edge.to < graph.poses.size(), "edges join poses");
    fuzz::Expect(edge.from != edge.to, "edges join two");
    fuzz::Expect(edge.T_from_to.matrix().allFinite() && edge.information.allFinite(), "edges are finite");
  }
  // Chained poses and repaired matrices may exceed the limits for numbers in a file.
  if (!file->has_poses || !file->warnings.empty()) return;
  const auto again = fuzz::TakenOrRefused(ParseG2o, ToG2o(*file));
  fuzz::Expect(again && again->ids == file->ids && again->graph.edges.size() == graph.edges.size(), "it is read again");
}

}  // namespace

std::vector<Bytes> fuzz::Seeds() {
  std::vector<Bytes> seeds{ToBytes(kPlanar), ToBytes(kSpatial), ToBytes(kEdges)};
  AddWords(seeds);
  return seeds;
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  merlin::Check(merlin::fuzz::ToText(data, size));
  return 0;
}
