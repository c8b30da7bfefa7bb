// Seven public pose graphs, whose optima are known: A certified as the global one by SE-Sync, B by g2o's definition.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "slam/graph/g2o_file.h"
#include "slam/graph/initial_poses.h"
#include "slam/graph/optimize.h"
#include "tests/support/shared_data.h"

namespace merlin {
namespace {

struct Optimum {
  const char* graph;
  std::size_t poses, edges;
  double a, b;  // to as many digits as they are known
};

const Optimum kOptima[] = {
    {"tinyGrid3D", 9, 11, 18.51937, 6.727882},         {"smallGrid3D", 125, 297, 1025.398, 458.15378},
    {"CSAIL", 1045, 1172, 31.703716, 40.555129},       {"intel", 1728, 2512, 52.3482273, 45.004696},
    {"manhattan", 3500, 5453, 6431.3914, 3549.0368},   {"sphere2500", 2500, 4949, 1687.005814, 727.14967},
    {"parking-garage", 1661, 6275, 1.262524, 1.23869},
};

class PublicGraphs : public testing::TestWithParam<Optimum> {};

TEST_P(PublicGraphs, EndAtTheKnownOptima) {
  const std::filesystem::path path = SharedData("pose_graphs") / (std::string(GetParam().graph) + ".g2o");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no public pose graphs: " << path << " does not exist";
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  G2oFile file = ParseG2o(text.str(), path.string());
  ASSERT_EQ(file.graph.poses.size(), GetParam().poses);
  ASSERT_EQ(file.graph.edges.size(), GetParam().edges);
  const auto start = ChordalPoses(file.graph);
  ASSERT_TRUE(start);
  file.graph.poses = *start;
  for (const Objective objective : {Objective::kA, Objective::kB}) {
    const double known = objective == Objective::kA ? GetParam().a : GetParam().b;
    const OptimizeResult result = Optimize(file.graph, {}, objective);
    EXPECT_TRUE(result.converged);
    EXPECT_LE(result.iterations, 12);
    EXPECT_NEAR(result.objective, known, 5e-7 * known);
    PoseGraph solved = file.graph;
    solved.poses = result.poses;
    EXPECT_NEAR(Evaluate(solved, objective), result.objective, 1e-9 * known);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PublicGraphs, testing::ValuesIn(kOptima), [](const auto& instance) {
  std::string name = instance.param.graph;
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace merlin
