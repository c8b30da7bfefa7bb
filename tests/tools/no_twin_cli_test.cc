// The car's own program as users run it: what it rejects, and how it ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

void ExpectOneSentence(const std::string& arguments, const std::string& sentence, const fs::path& folder) {
  const Outcome outcome = Merlin(arguments, folder);
  EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.said;
  EXPECT_NE(outcome.said.find(sentence), std::string::npos) << arguments << "\n" << outcome.said;
  EXPECT_EQ(std::count(outcome.said.begin(), outcome.said.end(), '\n'), 1) << outcome.said;
  EXPECT_FALSE(fs::exists(folder / "runs")) << arguments;
}

TEST(NoTwinCli, HasNoTwinToDrive) {
  const TemporaryFolder folder;
  for (const char* robot : {"", " --robot twin", " --robot emulated"})
    for (const char* subcommand : {"run", "drive"})
      ExpectOneSentence(std::string(subcommand) + " corridor_short" + robot,
                        "this program was built without the twin; expected hardware:FILE", folder.path());
  ExpectOneSentence("run corridor_short --robot moon", "unknown robot", folder.path());
}

TEST(NoTwinCli, RefusesAHardwareFileThatDoesNotFitBeforeItOpensADevice) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name, const char* text) { std::ofstream(folder.path() / name) << text; };
  file("other.yaml", "car: rover\ndrive: {serial: {port: /dev/merlin-none}}\n");
  file("twice.yaml", "drive: {serial: {port: /dev/merlin-none}}\ncompass: {serial: {port: /dev/merlin-none}}\n");
  file("right.yaml",
       "car: merlin\ndrive: {serial: {port: /dev/merlin-none}}\ndepth: {pmd: {library: /no/libpmd.so}}\n");
  for (const char* subcommand : {"run corridor_short", "doctor"}) {
    const std::string robot = std::string(subcommand) + " --robot hardware:";
    ExpectOneSentence(robot + "other.yaml", "other.yaml: these are the devices of another car", folder.path());
    ExpectOneSentence(robot + "twice.yaml", "twice.yaml: names a device twice", folder.path());
    ExpectOneSentence(robot + "none.yaml", "none.yaml", folder.path());
  }
  ExpectOneSentence("run room_turn_180 --robot hardware:right.yaml", "only the twin has a", folder.path());
  EXPECT_EQ(Merlin("run corridor_short --robot hardware:right.yaml", folder.path()).code, 3);  // no such port here
  EXPECT_FALSE(fs::exists(folder.path() / "runs"));
}

}  // namespace
}  // namespace merlin
