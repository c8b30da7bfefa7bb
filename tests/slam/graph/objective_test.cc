#include "slam/graph/objective.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "slam/graph/g2o_file.h"
#include "tests/slam/graph/random_graph.h"

namespace merlin {
namespace {

TEST(Objective, AIsTheSumOverMatrices) {
  for (const bool planar : {false, true}) {
    const PoseGraph graph = RandomGraphs(1).Walk(10, 0.4, planar);
    double sum = 0.0;
    for (const GraphEdge& edge : graph.edges) {
      const Pose &from = graph.poses[edge.from], &to = graph.poses[edge.to], &measured = edge.T_from_to;
      Matrix6d I = edge.information;
      double tau = 2.0 / I.topLeftCorner<2, 2>().inverse().trace(), kappa = I(5, 5);
      if (!planar) {
        I.bottomRightCorner<3, 3>() *= 4.0;  // as a file has it: over the quaternion's vector part, half our rotation
        tau = 3.0 / I.topLeftCorner<3, 3>().inverse().trace();
        kappa = 3.0 / (2.0 * I.bottomRightCorner<3, 3>().inverse().trace());
      }
      sum += kappa * (to.linear() - from.linear() * measured.linear()).squaredNorm() +
             tau * (to.translation() - from.translation() - from.linear() * measured.translation()).squaredNorm();
    }
    EXPECT_NEAR(Evaluate(graph, Objective::kA), sum, 1e-10 * sum);
  }
}

// By hand: the second pose lies 0.1 m ahead of where the edge has it in x, 0.2 rad turned: chi2 = 100 * 0.01 + 2 * 5 *
// 0.1 * 0.2 + 50 * 0.04.
TEST(Objective, BOfTwoPosesInThePlaneByHand) {
  const G2oFile file = ParseG2o(
      "VERTEX_SE2 0 5 5 1.5707963267948966\nVERTEX_SE2 1 5 6.1 1.7707963267948966\n"
      "EDGE_SE2 0 1 1 0 0 100 0 5 80 0 50\n",
      "f");
  EXPECT_NEAR(Evaluate(file.graph, Objective::kB), 1.0 + 0.2 + 2.0, 1e-12);
}

// By hand: a turn of 0.4 rad about x has the vector part (sin 0.2, 0, 0).
TEST(Objective, BOfTwoPosesInSpaceByHand) {
  const G2oFile file = ParseG2o(
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1.5 0 0 0.19866933079506122 0 0 0.98006657784124163\n"
      "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 4 0 0 3 0 0 4 0 0 0 0 4 0 0 0 70 0 0 70 0 70\n",
      "f");
  const double s = std::sin(0.2);
  EXPECT_NEAR(Evaluate(file.graph, Objective::kB), 4 * 0.25 + 2 * 3 * 0.5 * s + 70 * s * s, 1e-12);
}

TEST(Objective, WeighsNothingByASingularMatrix) {
  GraphEdge edge;
  edge.information.diagonal() << 1.0, 1.0, 0.0, 0.0, 1.0, 1.0;
  EXPECT_EQ(WeightsInA(edge, false).tau, 0.0);
  EXPECT_EQ(WeightsInA(edge, false).kappa, 0.0);
  EXPECT_EQ(WeightsInA(edge, true).tau, 1.0);
  edge.information.setZero();
  EXPECT_EQ(WeightsInA(edge, true).tau, 0.0);
}

}  // namespace
}  // namespace merlin
