#include "slam/graph/g2o_file.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "robot/base/error.h"
#include "slam/graph/initial_poses.h"
#include "slam/graph/optimize.h"
#include "tests/slam/graph/random_graph.h"
#include "tests/support/mutate.h"

namespace merlin {
namespace {

const std::string kPlanar =
    "# a triangle\n"
    "VERTEX_SE2 10 0 0 0\n"
    "VERTEX_SE2 30 1 1 1.5\n"
    "VERTEX_SE2 20 1 0 0\n"
    "FIX 20\n"
    "EDGE_SE2 10 20 1 0 0 11 12 13 22 23 33\n"
    "EDGE_SE2 20 30 0 1 1.5 500 0 0 500 0 500\n"
    "\n"
    "EDGE_SE2 30 10 -1 1 -1.5 500 0 0 500 0 500\n";

const std::string kUnit = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";
const std::string kSpatial =
    "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
    "VERTEX_SE3:QUAT 1 1 2 3 0 0 0.6 0.8\n"
    "EDGE_SE3:QUAT 0 1 1 2 3 0 0 0.6 0.8 1 2 3 4 5 6 20 7 8 9 10 30 11 12 13 40 14 15 50 16 60\n";

void ExpectRefused(const std::string& text, const std::string& part) {
  try {
    ParseG2o(text, "f.g2o");
    ADD_FAILURE() << "taken: " << text;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what() << "\n" << part;
  }
}

TEST(G2oFile, ReadsPosesByIdAndEdgesInThePlane) {
  const G2oFile file = ParseG2o(kPlanar, "f.g2o");
  EXPECT_TRUE(file.graph.planar && file.has_poses && file.warnings.empty());
  EXPECT_EQ(file.ids, (std::vector<std::int64_t>{10, 20, 30}));
  EXPECT_EQ(file.graph.fixed, std::vector<std::size_t>{1});
  EXPECT_NEAR(Yaw(file.graph.poses[2]), 1.5, 1e-15);
  ASSERT_EQ(file.graph.edges.size(), 3u);
  const GraphEdge& edge = file.graph.edges[0];
  EXPECT_EQ(edge.from, 0u);
  EXPECT_EQ(edge.to, 1u);
  Eigen::Matrix3d information;
  information << 11, 12, 13, 12, 22, 23, 13, 23, 33;
  const int rows[] = {0, 1, 5};
  EXPECT_EQ(edge.information(rows, rows), information);
  EXPECT_EQ(edge.information.row(2).norm(), 0.0);
}

TEST(G2oFile, ReadsSpatialInformationOverTwiceTheQuaternionsVectorPart) {
  const GraphEdge edge = ParseG2o(kSpatial, "f.g2o").graph.edges[0];
  EXPECT_EQ(edge.T_from_to.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(Yaw(edge.T_from_to), 2.0 * std::atan2(0.6, 0.8), 1e-15);
  EXPECT_TRUE(edge.information.isApprox(edge.information.transpose(), 0.0));
}

TEST(G2oFile, SharesOutSpatialInformationRowByRow) {
  std::string text = kSpatial.substr(0, kSpatial.rfind("EDGE"));
  text += "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1 100 1 2 3 4 5 101 6 7 8 9 102 10 11 12 103 13 14 104 15 105\n";
  const Matrix6d I = ParseG2o(text, "f.g2o").graph.edges[0].information;
  EXPECT_EQ(I(0, 0), 100);
  EXPECT_EQ(I(0, 2), 2);
  EXPECT_EQ(I(2, 1), 6);
  EXPECT_EQ(I(2, 2), 102);
  EXPECT_EQ(I(0, 5), 5 / 2.0);
  EXPECT_EQ(I(3, 2), 10 / 2.0);
  EXPECT_EQ(I(3, 4), 13 / 4.0);
  EXPECT_EQ(I(5, 5), 105 / 4.0);
}

TEST(G2oFile, ChainsPosesThatTheFileDoesNotHave) {
  const G2oFile file =
      ParseG2o("EDGE_SE2 5 6 1 0 1.5707963267948966 1 0 0 1 0 1\nEDGE_SE2 6 7 1 0 0 1 0 0 1 0 1\n", "f");
  EXPECT_FALSE(file.has_poses);
  ASSERT_EQ(file.graph.poses.size(), 3u);
  EXPECT_LT((file.graph.poses[2].translation() - Eigen::Vector3d(1, 1, 0)).norm(), 1e-15);
}

TEST(G2oFile, TakesWindowsLinesPlusSignsAndNoLastNewline) {
  const G2oFile file =
      ParseG2o("EDGE_SE2 0 1 +1.5 -2e0 .5 1 0 0 1 0 1\r\n\r\n#\r\nEDGE_SE2\t1  2 1 0 0 1 0 0 1 0 1 ", "f");
  EXPECT_EQ(file.graph.edges[0].T_from_to.translation(), Eigen::Vector3d(1.5, -2.0, 0.0));
  EXPECT_EQ(file.graph.poses.size(), 3u);
}

TEST(G2oFile, RefusesWithTheLine) {
  ExpectRefused("", "f.g2o: no edges");
  ExpectRefused("VERTEX_SE2 0 0 0 0\n", "f.g2o: no edges");
  ExpectRefused(kPlanar + "VERTEX_XY 4 1 1\n", "f.g2o:10: unknown tag");
  ExpectRefused(kPlanar + "EDGE_SE 4 1 1\n", "EDGE_SE2");
  ExpectRefused(kPlanar + "VERTEX_SE2 10 1 1 1\n", "f.g2o:10: pose 10 again; it is in line 2");
  ExpectRefused(kPlanar + "EDGE_SE2 10 99 1 0 0 1 0 0 1 0 1\n", "f.g2o:10: there is no pose 99");
  ExpectRefused(kPlanar + "FIX 99\n", "f.g2o:10: there is no pose 99");
  ExpectRefused(kPlanar + "FIX\n", "f.g2o:10: the line ends before the id");
  ExpectRefused(kPlanar + "EDGE_SE2 10 10 1 0 0 1 0 0 1 0 1\n", "f.g2o:10: an edge from a pose to itself");
  ExpectRefused(kPlanar + "EDGE_SE2 10 20 1 0 0 1 0 0 1 0\n", "f.g2o:10: the line ends before the information");
  ExpectRefused(kPlanar + "EDGE_SE2 10 20 1 0 0 1 0 0 1 0 1 7\n", "f.g2o:10: more fields");
  ExpectRefused(kPlanar + "EDGE_SE2 10 20 nan 0 0 1 0 0 1 0 1\n", "f.g2o:10: x; expected a number");
  ExpectRefused(kPlanar + "EDGE_SE2 10 20 1 0 0 inf 0 0 1 0 1\n", "f.g2o:10: the information");
  ExpectRefused(kPlanar + "EDGE_SE2 10 20 1 1e300 0 1 0 0 1 0 1\n", "f.g2o:10: y");
  ExpectRefused(kPlanar + "EDGE_SE2 10 2.5 1 0 0 1 0 0 1 0 1\n",
                "f.g2o:10: the second pose's id; expected a whole number, got '2.5'");
  ExpectRefused(kPlanar + "EDGE_SE2 10 99999999999999999999 1 0 0 1 0 0 1 0 1\n", "f.g2o:10: the second pose's id");
  ExpectRefused(kPlanar + kSpatial, "f.g2o:10: planar (SE2) and spatial (SE3)");
  ExpectRefused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n", "f.g2o:1: a quaternion of no length");
  ExpectRefused("FIX 5\nFIX 0 1\nEDGE_SE2 5 6 1 0 0 1 0 0 1 0 1\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n",
                "f.g2o:2: more than one FIX");
  ExpectRefused("FIX 0 1\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n", "f.g2o:1: more than one FIX");
  ExpectRefused(std::string(1000, 'x') + "\xff\x01", "f.g2o:1: unknown tag");
}

// Each fault is reported with its line, and a pose whose line is wrong is not also reported as missing.
TEST(G2oFile, NamesEveryFaultAtOnce) {
  try {
    ParseG2o(
        "VERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 x 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0\n"
        "EDGE_SE2 2 7 1 0 0 1 0 0 1 0 1\nFIX 8\nEDGE_SE9 1 2\n",
        "f");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "f:2: x; expected a number between -1e+09 and 1e+09, got 'x'\n"
                 "f:4: the line ends before the information matrix\n"
                 "f:7: unknown tag; expected EDGE_SE2 or another of g2o's poses and edges, got 'EDGE_SE9'\n"
                 "f:3: pose 1 again; it is in line 1 already\nf:5: there is no pose 7\nf:6: there is no pose 8");
  }
  try {
    ParseG2o("VERTEX_SE2 one 0 0 0\nVERTEX_SE2 2 0 0 0\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n", "f");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "f:1: the pose's id; expected a whole number, got 'one'");
  }
  std::string many;
  for (int i = 0; i < 20; ++i) many += "EDGE_SE2 1 1\n";
  ExpectRefused(many, "f.g2o:12: an edge from a pose to itself\nf.g2o: and 8 more");
}

TEST(G2oFile, IgnoresParametersThatNoEdgeUses) {
  for (const char* parameters :
       {"PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n", "PARAMS_SE2OFFSET 0 1 2 3\nPARAMS_CAMERACALIB 1 x nan\n", "PARAMS_\n"}) {
    EXPECT_EQ(ToG2o(ParseG2o(parameters + kPlanar, "f")), ToG2o(ParseG2o(kPlanar, "f")));
    EXPECT_EQ(ToG2o(ParseG2o(kSpatial + parameters, "f")), ToG2o(ParseG2o(kSpatial, "f")));
    EXPECT_TRUE(ParseG2o(kSpatial + parameters, "f").warnings.empty());
  }
  ExpectRefused("PARAMS_SE3OFFSET 0 1 0 0 0 0 0 1\n" + kSpatial + "EDGE_SE3_OFFSET 0 1 0 0 1 2 3 0 0 0 1" + kUnit,
                "f.g2o:5: an edge that uses a PARAMS line, which is not supported");
  ExpectRefused("PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n", "no edges");
}

TEST(G2oFile, WarnsOnceOfPartsThatNoEdgeJoins) {
  const std::string first = "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n", second = "EDGE_SE2 5 6 2 0 0 1 0 0 1 0 1\n";
  G2oFile file = ParseG2o(first + second + "FIX 1\nFIX 6\n", "f");
  EXPECT_EQ(file.warnings, std::vector<std::string>{"f: the graph has 2 parts that no edge joins; each is solved by "
                                                    "itself, about its FIX or its first pose"});
  const double x_m[] = {-1.0, 0.0, -2.0, 0.0};  // chained from each part's own FIX
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(file.graph.poses[i].translation(), Eigen::Vector3d(x_m[i], 0, 0));
  file = ParseG2o("\xEF\xBB\xBF" + kPlanar + "VERTEX_SE2 40 1 1 1\n", "f");
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_TRUE(file.warnings[0].ends_with("(1 of one pose, which stays)")) << file.warnings[0];
}

// Memory depends on how many elements a file has, not on their ids.
TEST(G2oFile, TakesIdsOfAnySize) {
  const G2oFile file = ParseG2o("EDGE_SE2 -9223372036854775808 9223372036854775807 1 0 0 1 0 0 1 0 1\n", "f");
  EXPECT_EQ(file.graph.poses.size(), 2u);
}

TEST(G2oFile, NamesWhatItMends) {
  std::string text = kPlanar + "EDGE_SE2 10 20 1 0 0 1 0 0 -1 0 1\nEDGE_SE2 10 20 1 0 0 1 0 0 -1 0 1\n";
  G2oFile file = ParseG2o(text, "f.g2o");
  ASSERT_EQ(file.warnings.size(), 2u);
  EXPECT_EQ(file.warnings[0],
            "f.g2o: 2 information matrices are not positive semidefinite; negative eigenvalues were set to zero (lines "
            "10, 11)");
  EXPECT_EQ(file.warnings[1], "f.g2o: 1 edge is said before, word for word; counted again (line 11)");
  EXPECT_LT(
      (Planar::Part(file.graph.edges[3].information) - Eigen::Vector3d(1, 0, 1).asDiagonal().toDenseMatrix()).norm(),
      1e-15);
  for (const GraphEdge& edge : file.graph.edges)
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix6d>(edge.information).eigenvalues().minCoeff(), -1e-12);

  file = ParseG2o(
      "EDGE_SE3:QUAT 0 1 1 2 3 0 0 1.2 1.6" + kUnit + "\nEDGE_SE3:QUAT 1 2 1 2 3 0 0 0.600001 0.8" + kUnit + "\n",
      "f.g2o");
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_EQ(file.warnings[0], "f.g2o: 1 quaternion is off unit length; normalised (line 1)");
  EXPECT_TRUE(file.graph.edges[0].T_from_to.linear().isUnitary(1e-14));
}

TEST(G2oFile, WritesWhatItReadsAgain) {
  for (const bool planar : {false, true}) {
    RandomGraphs random(1);
    G2oFile file{.graph = random.Walk(20, 0.1, planar), .has_poses = true};
    file.graph.fixed = {0, 3};
    for (std::size_t i = 0; i < file.graph.poses.size(); ++i) file.ids.push_back(7 * static_cast<std::int64_t>(i) - 3);
    const G2oFile again = ParseG2o(ToG2o(file), "f");
    EXPECT_EQ(again.ids, file.ids);
    EXPECT_EQ(again.graph.fixed, file.graph.fixed);
    EXPECT_TRUE(again.warnings.empty());
    for (std::size_t i = 0; i < file.ids.size(); ++i)
      EXPECT_LT((again.graph.poses[i].matrix() - file.graph.poses[i].matrix()).norm(), 1e-14);
    for (std::size_t i = 0; i < file.graph.edges.size(); ++i) {
      const GraphEdge &a = again.graph.edges[i], &b = file.graph.edges[i];
      EXPECT_EQ(std::pair(a.from, a.to), std::pair(b.from, b.to));
      EXPECT_LT((a.T_from_to.matrix() - b.T_from_to.matrix()).norm(), 1e-14);
      EXPECT_EQ(planar ? Matrix6d(Planar::Part(a.information).norm() * Matrix6d::Identity()) : a.information,
                planar ? Matrix6d(Planar::Part(b.information).norm() * Matrix6d::Identity()) : b.information);
    }
  }
}

// Every text is either accepted, and then solved without a fault, or rejected in one sentence.
TEST(G2oFile, SurvivesBrokenTexts) {
  const std::string seeds[] = {kPlanar, kSpatial,
                               "EDGE_SE2 5 6 1 0 1.5 1 0 0 1 0 1\nEDGE_SE2 6 7 1 0 0 1 0 0 1 0 1\nFIX 6\n"};
  Mutator mutator(1);
  int taken = 0;
  constexpr int kTexts = 20000;
  for (int i = 0; i < kTexts; ++i) {
    const std::string text = mutator.Mutated(seeds[i % 3]);
    try {
      G2oFile file = ParseG2o(text, "f.g2o");
      ++taken;
      ToG2o(file);
      if (auto poses = ChordalPoses(file.graph)) file.graph.poses = *poses;
      const OptimizeResult result = Optimize(file.graph, {.iterations_max = 20});
      EXPECT_TRUE(std::isfinite(result.objective)) << text;
      for (const Pose& pose : result.poses) EXPECT_TRUE(pose.matrix().allFinite()) << text;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string_view(error.what()).starts_with("f.g2o")) << error.what();
    }
  }
  EXPECT_GT(taken, kTexts / 50);
  EXPECT_LT(taken, kTexts / 2);
}

std::ptrdiff_t CountOf(const std::string& text, const std::string& word) {
  std::ptrdiff_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

// A truncated file is either accepted with every line in it, or rejected in one sentence. Truncated after the line of
// an edge, it is accepted.
TEST(G2oFile, EveryPrefixIsTakenOrRefused) {
  for (const std::string& whole : {kPlanar, kSpatial}) {
    int taken = 0;
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const std::string text = whole.substr(0, length);
      const std::size_t last_line = length < 2 ? 0 : text.rfind('\n', length - 2) + 1;  // npos + 1 is 0
      const bool ends_with_an_edge = text.ends_with('\n') && text.substr(last_line).starts_with("EDGE");
      try {
        const G2oFile file = ParseG2o(text, "f.g2o");
        ++taken;
        EXPECT_EQ(std::ssize(file.graph.edges), CountOf(text, "EDGE")) << text;
        EXPECT_EQ(std::ssize(file.ids), std::ssize(file.graph.poses)) << text;
        EXPECT_EQ(std::ssize(file.ids), CountOf(text, "VERTEX")) << text;
      } catch (const InputError& error) {
        EXPECT_TRUE(std::string_view(error.what()).starts_with("f.g2o")) << error.what();
        EXPECT_FALSE(ends_with_an_edge) << text;
      }
    }
    EXPECT_GT(taken, 0) << whole;
  }
}

}  // namespace
}  // namespace merlin
