// `merlin doctor` finds what a run would find, and ends with the exit code of a run.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

Outcome WithHome(const std::string& home, const std::string& arguments, const fs::path& folder) {
  return Run("MERLIN_HOME='" + home + "' '" MERLIN_BINARY "' " + arguments + " 2>&1", folder);
}

TEST(DoctorCli, CountsWhatIsInMerlinHome) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "home");
  fs::copy(fs::path(MERLIN_SOURCE_DIR) / "models", folder.path() / "home/models", fs::copy_options::recursive);
  fs::copy(fs::path(MERLIN_SOURCE_DIR) / "scenarios", folder.path() / "home/scenarios");
  for (const char* room : {"hall", "wall_7", "bend_10"})
    fs::remove(folder.path() / "home/models/rooms" / (std::string(room) + ".xml"));
  const auto files_in = [](const char* name) {
    return std::distance(fs::directory_iterator(fs::path(MERLIN_SOURCE_DIR) / "models" / name), {});
  };
  const std::string cameras = std::to_string(files_in("cameras")) + " cameras";
  const std::string rooms_here = std::to_string(files_in("rooms")) + " rooms, " + cameras;
  const std::string rooms_there =
      "home: the car, materials, " + std::to_string(files_in("rooms") - 3) + " rooms, " + cameras;
  const Outcome here = Merlin("doctor", folder.path()), there = WithHome("home", "doctor", folder.path());
  EXPECT_EQ(there.code, here.code);
  EXPECT_NE(here.said.find(rooms_here), std::string::npos) << here.said;
  EXPECT_NE(there.said.find(rooms_there), std::string::npos) << there.said;
  fs::remove(folder.path() / "home/models/materials.yaml");
  EXPECT_EQ(WithHome("home", "doctor", folder.path()).code, 2);
  EXPECT_EQ(WithHome("", "doctor", folder.path()).code, here.code);  // empty counts as not set
}

TEST(DoctorCli, EndsWithTwoWhereMerlinHomeIsWrongAsARunDoes) {
  const TemporaryFolder folder;
  for (const char* arguments : {"doctor", "doctor --json", "run corridor_short", "doctor --robot hardware:x.yaml"}) {
    const Outcome outcome = WithHome("nowhere", arguments, folder.path());
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.said;
  }
  EXPECT_NE(WithHome("nowhere", "doctor", folder.path()).said.find("is MERLIN_HOME right?"), std::string::npos);
}

TEST(DoctorCli, ChecksARobotWithTheExitCodeOfARunWithIt) {
  const TemporaryFolder folder;
  const std::pair<const char*, int> robots[] = {
      {"drive: {serial: {port: /dev/merlin-none}}\ndepth: {pmd: {library: /no/libpmd.so}}\n", 3},  // no such port
      {"drive: {serial: {port: /dev/null, baud: 1234}}\n", 2},                                     // no such rate
      {"drives: {serial: {port: /dev/null}}\n", 2},
      {"drive: [\n", 2}};
  for (const auto& [text, code] : robots) {
    std::ofstream(folder.path() / "car.yaml") << text;
    EXPECT_EQ(Merlin("run corridor_short --robot hardware:car.yaml", folder.path()).code, code) << text;
    EXPECT_EQ(Merlin("doctor --robot hardware:car.yaml", folder.path()).code, code) << text;
    EXPECT_EQ(Merlin("doctor --robot hardware:car.yaml --json", folder.path()).code, code) << text;
  }
  for (const char* robot : {"moon", "twin", "hardware:", "hardware:none.yaml", "hardware:.", "''"})
    EXPECT_EQ(Merlin(std::string("doctor --robot ") + robot, folder.path()).code, 2) << robot;
  EXPECT_EQ(Merlin("doctor --robot hardware:car.yaml --scenario corridor_lop", folder.path()).code, 2);
}

}  // namespace
}  // namespace merlin
