// --json: one JSON document on standard output and nothing else there, whatever is in the names.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

using Json = nlohmann::json;

Json Parsed(const std::string& arguments, int code, const std::filesystem::path& folder) {
  const Outcome outcome = Merlin(arguments + " --json", folder, "2>said");
  EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.said << Contents(folder / "said");
  Json json = Json::parse(outcome.said, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << arguments << "\n" << outcome.said;
  return json;
}

TEST(JsonCli, CalibrateNamesItsFileWhateverIsInTheName) {
  const TemporaryFolder folder;
  const Json json = Parsed("calibrate odometry --robot twin --out 'a \"b\" \\ ü.yaml'", 0, folder.path());
  EXPECT_EQ(json["file"], "a \"b\" \\ ü.yaml");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "a \"b\" \\ ü.yaml"));
  for (const char* key : {"wheel_radius_m", "wheelbase_m", "residual_rms"})
    EXPECT_GT(json[key].get<double>(), 0.0) << key;
  EXPECT_TRUE(json["steering_offset_rad"].is_number());
}

// Only one floor, because each takes two seconds.
TEST(JsonCli, CalibrateStudyIsAList) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const fs::path source = MERLIN_SOURCE_DIR, home = folder.path() / "home";
  fs::create_directories(home / "models");
  fs::create_directory_symlink(source / "scenarios", home / "scenarios");
  for (const fs::directory_entry& entry : fs::directory_iterator(source / "models"))
    if (entry.path().filename() != "materials.yaml")
      fs::create_symlink(entry, home / "models" / entry.path().filename());
  std::istringstream materials(Contents(source / "models/materials.yaml"));
  std::ofstream one_floor(home / "models/materials.yaml");
  for (std::string line; std::getline(materials, line);)
    if (line.find(" floor_") == std::string::npos || line.find(" floor_tiles:") != std::string::npos)
      one_floor << line << "\n";
  one_floor.close();
  const Outcome outcome =
      merlin::Run("MERLIN_HOME=home '" MERLIN_BINARY "' calibrate odometry --study --json 2>said", folder.path());
  EXPECT_EQ(outcome.code, 0) << Contents(folder.path() / "said");
  const Json json = Json::parse(outcome.said);
  ASSERT_GE(json.size(), 2u);
  for (const Json& row : json) {
    EXPECT_EQ(row["surface"], "floor_tiles");
    EXPECT_GT(row["before_percent"].get<double>(), row["after_percent"].get<double>());
  }
}

TEST(JsonCli, DoctorTellsOfEveryDevice) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "käfer.yaml") << "drive: {serial: {port: /dev/merlin-none-1}}\n"
                                                 "compass: {serial: {port: /dev/merlin-none-2}}\n"
                                                 "depth: {pmd: {library: /no/libpmd.so}}\n";
  const Json json = Parsed("doctor --robot hardware:käfer.yaml", 3, folder.path());
  EXPECT_EQ(json["well"], false);
  EXPECT_EQ(json["robot"], "hardware:käfer.yaml");
  ASSERT_EQ(json["devices"].size(), 3u);
  const char* names[] = {"drive", "compass", "depth camera"};
  const char* parts[] = {"/dev/merlin-none-1", "/dev/merlin-none-2", "/no/libpmd.so"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(json["devices"][i]["device"], names[i]);
    EXPECT_EQ(json["devices"][i]["works"], false);
    EXPECT_NE(json["devices"][i]["detail"].get<std::string>().find(parts[i]), std::string::npos);
  }
}

TEST(JsonCli, DoctorTellsOfTheMachineAndOfLicences) {
  const TemporaryFolder folder;
  EXPECT_TRUE(Parsed("doctor --licenses", 0, folder.path()).is_array());
  const Outcome outcome = Merlin("doctor --json", folder.path(), "2>said");
  EXPECT_TRUE(Json::parse(outcome.said)["versions"].contains("merlin")) << outcome.said;
}

TEST(JsonCli, CameraNamesItsModelWhateverIsInTheName) {
  const TemporaryFolder folder;
  std::string sheet = Contents(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/pmd_3k_s.yaml");
  sheet.replace(sheet.find("name: pmd_3k_s"), 14, "name: 'my \"ü\" \\'");
  std::ofstream(folder.path() / "mine.yaml") << sheet;
  EXPECT_EQ(Parsed("camera mine.yaml --wall 2 --frames 1 --out o", 0, folder.path())["model"], "my \"ü\" \\");
  const Json study = Parsed("camera mine.yaml --study motion --out o", 0, folder.path());
  EXPECT_EQ(study["model"], "my \"ü\" \\");
  EXPECT_EQ(Json::parse(Contents(folder.path() / "o/result.json")), study);
}

TEST(JsonCli, RunPutsItsNoteOnStandardError) {
  const TemporaryFolder folder;
  const Json json = Parsed("run corridor_short --gl off --duration 1 --set checks={} --out o", 0, folder.path());
  EXPECT_EQ(json["verdict"], "not judged");
  EXPECT_EQ(Json::parse(Contents(folder.path() / "o/result.json")), json);
  EXPECT_NE(Contents(folder.path() / "said").find("--gl is off"), std::string::npos);
}

TEST(JsonCli, PrintsNothingToStandardOutputForBadInput) {
  const TemporaryFolder folder;
  for (const char* arguments :
       {"run none", "camera none --wall 2", "camera pmd_3k_s", "calibrate odometry none.yaml", "calibrate odometry",
        "register none.ply none.ply", "optimize none.g2o", "eval none.tum none.tum", "bench none",
        "doctor --robot moon", "doctor --robot hardware:none.yaml", "doctor --bogus"}) {
    const Outcome outcome = Merlin(std::string(arguments) + " --json", folder.path(), "2>said");
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.said, "") << arguments;
    EXPECT_NE(Contents(folder.path() / "said"), "") << arguments;
  }
}

}  // namespace
}  // namespace merlin
