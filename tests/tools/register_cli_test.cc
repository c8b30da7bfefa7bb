// `merlin register` as users run it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>

#include "robot/types/se3.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

Outcome Register(const std::string& arguments, const TemporaryFolder& folder) {
  return Merlin("register " + arguments, folder.path());
}

// A room's corner, moved.
void WriteCorner(const std::filesystem::path& file, const Pose& T, bool only_floor = false) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(0.0, 2.0);
  std::ofstream out(file);
  out.precision(12);
  for (int i = 0; i < 1500; ++i) {
    Eigen::Vector3d p(at(random), at(random), at(random));
    p(only_floor ? 2 : i % 3) = 0.0;
    p = T * p;
    out << p.x() << "," << p.y() << "," << p.z() << "\n";
  }
}

TEST(RegisterCli, PrintsThePoseForMachines) {
  const TemporaryFolder folder;
  const Pose T = FromXyYaw(0.05, -0.03, 0.04);
  WriteCorner(folder.path() / "s.csv", Pose::Identity());
  WriteCorner(folder.path() / "t.csv", T);
  for (const char* options :
       {"", "--method point --max-distance 0.5", "--method plane", "--guess 0.04,-0.03,0,0,0,0.05", "--voxel 0.02",
        "--guess 1,0,0,0.01,0,1,0,0,0,0,1,0,0,0,0,1"}) {
    const Outcome outcome = Register(std::string("s.csv t.csv --json ") + options, folder);
    ASSERT_EQ(outcome.code, 0) << outcome.said;
    const auto json = nlohmann::json::parse(outcome.said);
    ASSERT_EQ(json["T_target_source"].size(), 16u);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        EXPECT_NEAR(json["T_target_source"][static_cast<std::size_t>(4 * i + j)].get<double>(), T.matrix()(i, j), 0.005)
            << options;
    EXPECT_TRUE(json["converged"].get<bool>());
    EXPECT_LT(json["rms_m"].get<double>(), 0.03);
    EXPECT_GT(json["overlap"].get<double>(), 0.99);
    EXPECT_GE(json["iterations"].get<int>(), 1);
    EXPECT_GE(json["time_ms"].get<double>(), 0.0);
    EXPECT_TRUE(json["undetermined"].empty());
  }
}

TEST(BenchRegister, SaysWithExitThreeThatSmallGicpIsAbsent) {
  const TemporaryFolder folder;
  const Outcome outcome = merlin::Run("MERLIN_ORACLES=none '" MERLIN_BINARY "' bench register 2>&1", folder.path());
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.said.find("no small_gicp in none"), std::string::npos) << outcome.said;
}

TEST(RegisterCli, WritesTheAlignedSourceWhole) {
  const TemporaryFolder folder;
  WriteCorner(folder.path() / "s.csv", Pose::Identity());
  WriteCorner(folder.path() / "t.csv", FromXyYaw(0.05, 0.0, 0.02));
  EXPECT_EQ(Register("s.csv t.csv --voxel 0.1 --out a.ply", folder).code, 0);
  EXPECT_NE(Contents(folder.path() / "a.ply").find("element vertex 1500\n"), std::string::npos);
  EXPECT_EQ(Register("a.ply t.csv", folder).code, 0);
  EXPECT_EQ(Register("s.csv t.csv --out no/such/folder.ply", folder).code, 2);
}

// The corner at coordinates of a national grid. The written cloud lies where the printed pose, in doubles, puts it,
// both in JSON and in text; relative to the corner the pose is that of the corner at the origin.
TEST(RegisterCli, KeepsATenthOfAMillimetreFarFromTheOrigin) {
  const TemporaryFolder folder;
  const Pose far(Eigen::Translation3d(433000.0, 5614000.0, 250.0)), T = FromXyYaw(0.05, -0.03, 0.04);
  WriteCorner(folder.path() / "s.csv", far);
  WriteCorner(folder.path() / "t.csv", far * T);
  const Outcome outcome = Register("s.csv t.csv --json --out a.csv", folder);
  ASSERT_EQ(outcome.code, 0) << outcome.said;
  const auto json = nlohmann::json::parse(outcome.said);
  std::istringstream text(Register("s.csv t.csv --out a.ply", folder).said);
  std::string title;
  text >> title;
  Eigen::Matrix4d of_json, of_text;
  for (int i = 0; i < 16; ++i) {
    of_json(i / 4, i % 4) = json["T_target_source"][static_cast<std::size_t>(i)].get<double>();
    text >> of_text(i / 4, i % 4);
  }
  EXPECT_LT((far.inverse().matrix() * of_json * far.matrix() - T.matrix()).norm(), 0.01);
  std::ifstream source(folder.path() / "s.csv"), aligned(folder.path() / "a.csv");
  std::string header;
  std::getline(aligned, header);
  EXPECT_EQ(header, "x,y,z");
  int points = 0;
  char comma = 0;
  const auto read = [&comma](std::ifstream& in, Eigen::Vector4d& p) {
    return static_cast<bool>(in >> p(0) >> comma >> p(1) >> comma >> p(2));
  };
  for (Eigen::Vector4d p(0, 0, 0, 1), a(0, 0, 0, 1); read(source, p) && read(aligned, a); ++points) {
    ASSERT_LT((of_json * p - a).norm(), 1e-4);
    ASSERT_LT((of_text * p - a).norm(), 1e-4);
  }
  EXPECT_EQ(points, 1500);
  EXPECT_NE(Contents(folder.path() / "a.ply").find("property double x\n"), std::string::npos);
}

TEST(RegisterCli, SaysWhatItLeftOutOfAFile) {
  const TemporaryFolder folder;
  WriteCorner(folder.path() / "t.csv", Pose::Identity());
  std::ofstream(folder.path() / "s.csv") << Contents(folder.path() / "t.csv") << "1,,1\nnan,1,1\n";
  EXPECT_NE(Register("s.csv t.csv", folder).said.find("left out: 2 and 0 points whose coordinates are empty"),
            std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(Register("t.csv s.csv --json", folder).said)["left_out"], nlohmann::json({0, 2}));
  EXPECT_EQ(Register("t.csv t.csv --out a.ply", folder).code, 0);
  std::ofstream(folder.path() / "a.ply", std::ios::app) << "more";
  EXPECT_NE(Register("a.ply t.csv", folder).said.find("merlin: warning: a.ply: 4 bytes behind"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(Register("a.ply t.csv --json", folder).said)["warnings"].size(), 1u);
}

TEST(RegisterCli, SaysWithExitOneThatItDidNotConverge) {
  const TemporaryFolder folder;
  WriteCorner(folder.path() / "s.csv", Pose::Identity());
  WriteCorner(folder.path() / "far.csv", FromXyYaw(50.0, 0.0, 0.0));
  WriteCorner(folder.path() / "floor.csv", Pose::Identity(), true);
  std::ofstream(folder.path() / "line.csv") << "0,0,0\n1,1,1\n2,2,2\n3,3,3\n";
  std::ofstream(folder.path() / "same.csv") << "1,1,1\n1,1,1\n1,1,1\n1,1,1\n";
  const std::pair<const char*, const char*> cases[] = {
      {"s.csv far.csv", "too few pairs"},         {"floor.csv floor.csv", "3 of 6 directions"},
      {"line.csv line.csv", "1 of 6 directions"}, {"same.csv same.csv", "not converged"},
      {"s.csv same.csv", "not converged"},        {"same.csv s.csv", "not converged"}};
  for (const auto& [files, part] : cases) {
    const Outcome outcome = Register(files, folder);
    EXPECT_EQ(outcome.code, 1) << outcome.said;
    EXPECT_NE(outcome.said.find(part), std::string::npos) << outcome.said;
    const auto json = nlohmann::json::parse(Register(std::string(files) + " --json", folder).said);
    EXPECT_FALSE(json["converged"].get<bool>()) << files;
  }
}

TEST(RegisterCli, RefusesBadInputInOneSentence) {
  const TemporaryFolder folder;
  WriteCorner(folder.path() / "s.csv", Pose::Identity());
  std::ofstream(folder.path() / "two.csv") << "x,y,z\n1,2,3\nnan,1,1\n4,5,6\n";
  std::ofstream(folder.path() / "empty.csv");
  std::ofstream(folder.path() / "bad.csv") << "1,2,3\n1,2\n";
  std::ofstream(folder.path() / "huge.ply")
      << "ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n1 2 3\n";
  const std::pair<const char*, const char*> cases[] = {
      {"s.csv", "target"},
      {"s.csv none.ply", "none.ply"},
      {"s.csv two.csv", "two.csv: too few points; expected 3 or more, got 2, with 1 left out"},
      {"empty.csv s.csv", "empty.csv"},
      {"s.csv bad.csv", "bad.csv:2"},
      {"s.csv huge.ply", "huge.ply:3"},
      {"s.csv s.dae", "s.dae: not a cloud by its name; expected a .ply, .pcd, .csv, .txt, .xyz, .asc or .pts"},
      {"s.csv s.csv --method icp", "--method"},
      {"s.csv s.csv --voxel 0", "--voxel"},
      {"s.csv s.csv --max-distance nan", "--max-distance"},
      {"s.csv s.csv --guess 1,2,3", "--guess"},
      {"s.csv s.csv --guess 1,2,3,4,5,x", "--guess"},
      {"s.csv s.csv --guess 2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "not a rotation"},
      {"s.csv s.csv --guess -1,0,0,0,0,nan", "--guess"}};
  for (const auto& [arguments, part] : cases) {
    const Outcome outcome = Register(arguments, folder);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.said;
    EXPECT_EQ(std::ranges::count(outcome.said, '\n'), 1) << outcome.said;
    EXPECT_NE(outcome.said.find(part), std::string::npos) << outcome.said;
  }
  EXPECT_LE(std::ranges::count(Register("--help", folder).said, '\n'), 40);
}

}  // namespace
}  // namespace merlin
