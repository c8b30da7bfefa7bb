// `merlin optimize` and `merlin eval` as users run them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "scenarios/judge/writers.h"
#include "tests/support/oracles.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

nlohmann::json Json(const std::string& arguments, const std::filesystem::path& folder) {
  const Outcome outcome = Merlin(arguments + " --json", folder, "");
  EXPECT_EQ(outcome.code, 0) << arguments;
  return nlohmann::json::parse(outcome.said);
}

void ExpectRefused(const std::string& arguments, const std::string& part, const std::filesystem::path& folder) {
  const Outcome outcome = Merlin(arguments, folder);
  EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.said;
  EXPECT_NE(outcome.said.find(part), std::string::npos) << arguments << "\n" << outcome.said;
  EXPECT_FALSE(std::filesystem::exists(folder / "solved.g2o"));
}

// A square of 1 m whose last corner is measured 0.04 rad too wide: each of four equal edges takes 0.01 rad in B.
const char* const kSquare =
    "EDGE_SE2 0 1 0 0 1.5707963267948966 1 0 0 1 0 100\nEDGE_SE2 1 2 0 0 1.5707963267948966 1 0 0 1 0 100\n"
    "EDGE_SE2 2 3 0 0 1.5707963267948966 1 0 0 1 0 100\nEDGE_SE2 3 0 0 0 1.6107963267948966 1 0 0 1 0 100\n";

TEST(OptimizeCli, SolvesWritesAndReadsItsOwnFile) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "square.g2o") << kSquare;
  const nlohmann::json solved = Json("optimize square.g2o --out solved.g2o", folder.path());
  EXPECT_NEAR(solved["objective_b"], 4 * 100 * 0.01 * 0.01, 1e-9);
  EXPECT_NEAR(solved["objective_a"], 4 * 100 * 8 * std::pow(std::sin(0.005), 2), 1e-9);
  EXPECT_TRUE(solved["converged"]);
  EXPECT_GE(solved["iterations"], 1);
  EXPECT_GE(solved["time_s"], 0.0);
  EXPECT_GE(solved["iteration_ms"], 0.0);
  EXPECT_TRUE(solved["warnings"].empty());
  const nlohmann::json again = Json("optimize solved.g2o --objective b", folder.path());
  EXPECT_NEAR(again["objective_b"], solved["objective_b"], 1e-12);
}

TEST(OptimizeCli, RefusesBadInputWithOneSentenceAndWritesNothing) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "square.g2o") << kSquare;
  std::ofstream(folder.path() / "faults.g2o") << kSquare << "EDGE_SE2 7 7\nFIX x\n";
  std::ofstream(folder.path() / "empty.g2o");
  ExpectRefused("optimize", "graph", folder.path());
  ExpectRefused("optimize none.g2o --out solved.g2o", "none.g2o: cannot be read", folder.path());
  ExpectRefused("optimize . --out solved.g2o", "cannot be read", folder.path());
  ExpectRefused("optimize faults.g2o --out solved.g2o", "faults.g2o:5: an edge from", folder.path());
  ExpectRefused("optimize faults.g2o --out solved.g2o", "faults.g2o:6: the id", folder.path());
  ExpectRefused("optimize empty.g2o --out solved.g2o", "no edges", folder.path());
  ExpectRefused("optimize square.g2o --objective c", "--objective", folder.path());
  ExpectRefused("optimize square.g2o --out ''", "--out", folder.path());
  EXPECT_EQ(Merlin("optimize square.g2o --out none/solved.g2o", folder.path()).code, 2);
}

// The square twice: each is solved as the square alone, about its own FIX or its first pose.
TEST(OptimizeCli, SolvesPartsThatNoEdgeJoinsByThemselves) {
  const TemporaryFolder folder;
  const std::string second =
      "EDGE_SE2 40 41 0 0 1.5707963267948966 1 0 0 1 0 100\nEDGE_SE2 41 42 0 0 1.5707963267948966 1 0 0 1 0 100\n"
      "EDGE_SE2 42 43 0 0 1.5707963267948966 1 0 0 1 0 100\nEDGE_SE2 43 40 0 0 1.6107963267948966 1 0 0 1 0 100\n";
  std::ofstream(folder.path() / "one.g2o") << kSquare;
  std::ofstream(folder.path() / "two.g2o") << "PARAMS_SE2OFFSET 0 0 0 0\n" << kSquare << second << "FIX 42\n";
  const nlohmann::json one = Json("optimize one.g2o", folder.path());
  const nlohmann::json two = Json("optimize two.g2o --out solved.g2o", folder.path());
  EXPECT_EQ(one["parts"], 1);
  EXPECT_EQ(two["parts"], 2);
  EXPECT_TRUE(one["warnings"].empty());
  EXPECT_EQ(two["warnings"].size(), 1u);
  EXPECT_TRUE(two["converged"]);
  for (const char* objective : {"objective_a", "objective_b"})
    EXPECT_NEAR(two[objective].get<double>(), 2.0 * one[objective].get<double>(), 1e-12);
  EXPECT_NE(Contents(folder.path() / "solved.g2o").find("VERTEX_SE2 42 0 0 0\n"), std::string::npos);
  EXPECT_EQ(Json("optimize solved.g2o", folder.path())["objective_b"], two["objective_b"]);
}

TEST(OptimizeCli, SaysWhatItMended) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bad.g2o") << kSquare << "EDGE_SE2 1 3 0 0 3.1 1 0 0 -1 0 100\n";
  EXPECT_NE(Merlin("optimize bad.g2o", folder.path()).said.find("warning: bad.g2o: 1 information matrix"),
            std::string::npos);
  EXPECT_EQ(Json("optimize bad.g2o", folder.path())["warnings"].size(), 1u);
}

TEST(OptimizeCli, EndsAtTheKnownOptimumOfAPublicGraph) {
  const auto graph = SharedData("pose_graphs") / "intel.g2o";
  if (!std::filesystem::exists(graph)) GTEST_SKIP() << "no public pose graphs: " << graph << " does not exist";
  const TemporaryFolder folder;
  EXPECT_NEAR(Json("optimize '" + graph.string() + "' --objective a", folder.path())["objective_a"], 52.3482273, 1e-6);
  EXPECT_NEAR(Json("optimize '" + graph.string() + "' --objective b", folder.path())["objective_b"], 45.004696, 1e-6);
}

// A straight path of 3 m, seen 1 cm too far left and right alternately, and rotated as a whole.
struct Straight {
  TemporaryFolder folder;
  Straight() {
    std::ofstream truth(folder.path() / "truth.tum"), estimate(folder.path() / "estimate.tum");
    for (int i = 0; i <= 60; ++i) {
      truth << i << " " << 0.05 * i << " " << (i % 3 == 0) << " 0 0 0 0 1\n";
      estimate << i + 0.001 << " " << 5 - (i % 3 == 0) << " " << 0.05 * i << " " << (i % 2 ? 0.01 : -0.01)
               << " 0 0 0.70710678118654752 0.70710678118654752\n";
    }
  }
};

TEST(EvalCli, GivesTheFiguresByHand) {
  const Straight straight;
  const nlohmann::json figures = Json("eval truth.tum estimate.tum", straight.folder.path());
  EXPECT_EQ(figures["pairs"], 61);
  EXPECT_NEAR(figures["ate_rmse_m"], 0.01, 1e-5);
  EXPECT_NEAR(figures["ate_max_m"], 0.01,
              6e-4);  // an odd number of them: the mean is off by 0.01 / 61, and the fit tilts
  EXPECT_NEAR(figures["rpe_rotation_rmse_deg"], 0.0, 1e-6);
  EXPECT_EQ(figures["scale"], 1.0);
  const nlohmann::json none = Json("eval truth.tum estimate.tum --align none --delta 100", straight.folder.path());
  EXPECT_GT(none["ate_rmse_m"], 3.0);
  EXPECT_TRUE(none["rpe_translation_rmse_m"].is_null());
  EXPECT_EQ(none["rpe_pairs"], 0);
  EXPECT_NEAR(Json("eval truth.tum estimate.tum --align sim3", straight.folder.path())["scale"], 1.0, 1e-4);
}

TEST(EvalCli, RefusesBadInputWithOneSentence) {
  const Straight straight;
  const auto& folder = straight.folder.path();
  std::ofstream(folder / "late.tum") << "1000 0 0 0 0 0 0 1\n";
  std::ofstream(folder / "back.tum") << "1 0 0 0 0 0 0 1\n0.5 0 0 0 0 0 0 1\n";
  std::ofstream(folder / "two.tum") << "1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n";
  std::ofstream(folder / "stands.tum") << "1 1 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 1 0 0 0 0 0 1\n";
  ExpectRefused("eval truth.tum", "estimate", folder);
  ExpectRefused("eval truth.tum none.tum", "none.tum: cannot be read", folder);
  ExpectRefused("eval truth.tum late.tum", "late.tum: no stamp within 0.02 s", folder);
  ExpectRefused("eval back.tum truth.tum", "back.tum:2: the stamp", folder);
  ExpectRefused("eval truth.tum two.tum", "two.tum: too few pairs for a figure; expected 3 or more", folder);
  for (const char* align : {"none", "se3", "sim3"}) {
    const std::string option = std::string(" --align ") + align, part = "stands.tum: the positions of all 3 pairs";
    ExpectRefused("eval truth.tum stands.tum" + option, part, folder);
    ExpectRefused("eval stands.tum truth.tum" + option, part, folder);
  }
  ExpectRefused("eval truth.tum estimate.tum --align so3", "--align", folder);
  for (const char* number : {"nan", "0", "-1", "inf", "x", "''"})
    ExpectRefused("eval truth.tum estimate.tum --delta " + std::string(number), "--delta", folder);
  ExpectRefused("eval truth.tum estimate.tum --max-difference nan", "--max-difference", folder);
  EXPECT_EQ(Merlin("eval truth.tum estimate.tum --max-difference 0", folder).code, 2);
  EXPECT_EQ(Merlin("eval truth.tum truth.tum --max-difference 0", folder).code, 0);
}

// Figures by evo 1.38.1: evo_ape -a [-s], evo_rpe --delta 1 --delta_unit m --all_pairs --pairs_from_reference,
// --t_max_diff 0.02.
TEST(EvalCli, AgreesWithEvoOnARealTrajectory) {
  const auto data = SharedData("trajectories");
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no real trajectories: " << data << " does not exist";
  const TemporaryFolder folder;
  const std::string files = "eval '" + (data / "freiburg1_xyz-groundtruth.txt").string() + "' '" +
                            (data / "freiburg1_xyz-rgbdslam.txt").string() + "'";
  const nlohmann::json figures = Json(files, folder.path());
  EXPECT_EQ(figures["pairs"], 786);
  EXPECT_NEAR(figures["ate_rmse_m"], 0.013473468, 1e-9);
  EXPECT_EQ(figures["rpe_pairs"], 650);
  EXPECT_NEAR(figures["rpe_translation_rmse_m"], 0.01776368532, 1e-8);
  EXPECT_NEAR(figures["rpe_rotation_rmse_deg"], 0.818638863, 1e-6);
}

// The output of an evo program, with its settings in the test's folder instead of the user's home.
std::string Evo(const std::string& program, const std::string& arguments, const std::filesystem::path& folder) {
  const std::string command = "HOME=\"$PWD\" '" + OracleProgram(program).string() + "' ";
  const Outcome outcome = Run(command + arguments + " 2>&1", folder);
  EXPECT_EQ(outcome.code, 0) << command << arguments << "\n" << outcome.said << "\ntools/merlin test installs evo";
  return outcome.said;
}

// The value in a line such as "   rmse\t0.013473".
double Figure(const std::string& said, const std::string& name) {
  const std::size_t at = said.find(name + "\t");
  return at == std::string::npos ? NAN : std::stod(said.substr(at + name.size() + 1));
}

// Two minutes of a random walk seen at other times, at another scale, with noise: every figure as evo prints it, to its
// six digits.
TEST(EvalCli, AgreesWithEvoOnARandomWalk) {
  const TemporaryFolder folder;
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  const auto tangent = [&](double size) {
    return Vector6d(size * Vector6d::NullaryExpr([&] { return normal(generator); }));
  };
  Trajectory truth, estimate;
  Pose pose = Exp(tangent(1.0));
  for (int i = 0; i < 1200; ++i) {
    pose = pose * Exp(tangent(0.05));
    truth.push_back({std::chrono::milliseconds(100 * i), pose});
    if (i % 3 == 1) {
      Pose seen = Exp(Vector6d::Ones()) * pose * Exp(tangent(0.02));
      seen.translation() *= 1.1;
      estimate.push_back({std::chrono::milliseconds(100 * i + i % 5), seen});
    }
  }
  WriteFile(folder.path() / "truth.tum", ToTum(truth));
  WriteFile(folder.path() / "estimate.tum", ToTum(estimate));
  const std::string files = " truth.tum estimate.tum ";
  const std::string relative = "tum" + files + "--delta 1 --delta_unit m --all_pairs --pairs_from_reference ";
  const std::pair<const char*, const char*> kWays[] = {{"none", ""}, {"se3", "-a"}, {"sim3", "-as"}};
  for (const auto& [align, option] : kWays) {
    const nlohmann::json figures = Json("eval" + files + "--align " + align, folder.path());
    EXPECT_EQ(figures["pairs"], 400);
    const std::string ape = Evo("evo_ape", "tum" + files + option, folder.path());
    const std::string translation = Evo("evo_rpe", relative + option, folder.path());
    const std::string rotation = Evo("evo_rpe", relative + option + " --pose_relation angle_deg", folder.path());
    for (const std::string name : {"rmse", "mean", "median", "std", "min", "max"}) {
      EXPECT_NEAR(figures["ate_" + name + "_m"], Figure(ape, name), 2e-6) << align << " " << name;
      EXPECT_NEAR(figures["rpe_translation_" + name + "_m"], Figure(translation, name), 2e-6) << align << " " << name;
      EXPECT_NEAR(figures["rpe_rotation_" + name + "_deg"], Figure(rotation, name), 2e-6) << align << " " << name;
    }
  }
}

// Stamps on a grid of 0.1 s, many of them equal, in files of either length, a byte-order mark before one: the same
// pairs, hence the same figures, as evo.
TEST(EvalCli, PairsEqualStampsAsEvoDoes) {
  const TemporaryFolder folder;
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  const auto write = [&](const char* name, int poses) {
    std::string text = "\xEF\xBB\xBF";
    for (int i = 0, tenths = 0; i < poses; ++i, tenths += static_cast<int>(generator() % 3))
      text += fmt::format("{:.1f} {} {} {} 0 0 0 1\n", 0.1 * tenths, 0.1 * tenths + 0.01 * normal(generator),
                          std::sin(0.1 * tenths), 0.01 * normal(generator));
    WriteFile(folder.path() / name, text);
  };
  for (const int poses : {60, 80, 100}) {
    write("truth.tum", 80);
    write("estimate.tum", poses);
    const std::string files = " truth.tum estimate.tum ";
    const std::string ape = Evo("evo_ape", "tum" + files + "-a --t_max_diff 0.2", folder.path());
    const std::string rpe =
        Evo("evo_rpe", "tum" + files + "--delta 1 --delta_unit m --all_pairs --pairs_from_reference --t_max_diff 0.2",
            folder.path());
    const nlohmann::json figures = Json("eval" + files + "--max-difference 0.2", folder.path());
    EXPECT_EQ(figures["warnings"].size(), 2u);
    for (const std::string name : {"rmse", "mean", "max"}) {
      EXPECT_NEAR(figures["ate_" + name + "_m"], Figure(ape, name), 2e-6) << poses << " " << name;
      EXPECT_NEAR(figures["rpe_translation_" + name + "_m"], Figure(rpe, name), 2e-6) << poses << " " << name;
    }
  }
}

TEST(GraphCli, HelpFitsAScreen) {
  const TemporaryFolder folder;
  for (const char* arguments : {"optimize --help", "eval --help"}) {
    const Outcome outcome = Merlin(arguments, folder.path());
    EXPECT_EQ(outcome.code, 0);
    EXPECT_LE(std::ranges::count(outcome.said, '\n'), 40);
  }
}

}  // namespace
}  // namespace merlin
