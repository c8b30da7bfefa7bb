// --out: a bad path gives the same exit code and one sentence in every subcommand, before any work starts.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

class OutCli : public testing::Test {
 protected:
  OutCli() {
    std::ofstream(At("file")) << "kept";
    fs::create_directory(At("mine"));
    std::ofstream(At("mine/letter.txt")) << "dear";
    fs::create_symlink(At("nowhere"), At("dangling"));
    std::ofstream(At("cloud.csv")) << "0,0,0\n1,0,0\n0,1,0\n0,0,1\n1,1,1\n2,1,0\n";
    std::ofstream(At("graph.g2o")) << "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";
    std::ofstream(At("hardware.yaml")) << "drive: {serial: {port: /dev/merlin-none}}\n";
    before_ = Names();
  }

  fs::path At(const std::string& name) const { return folder_.path() / name; }
  std::set<std::string> Names() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) names.insert(entry.path().string());
    return names;
  }
  void ExpectRefused(const std::string& command, const std::string& out) const {
    const Outcome outcome = Merlin(command + " --out " + out, folder_.path(), "2>&1 </dev/null");
    EXPECT_EQ(outcome.code, 2) << command << " --out " << out << "\n" << outcome.said;
    EXPECT_NE(outcome.said.find("--out"), std::string::npos) << command << " --out " << out << "\n" << outcome.said;
    EXPECT_EQ(std::ranges::count(outcome.said, '\n'), 1) << command << " --out " << out << "\n" << outcome.said;
    EXPECT_EQ(Names(), before_) << command << " --out " << out;
    EXPECT_EQ(Contents(At("file")), "kept");
    EXPECT_EQ(Contents(At("mine/letter.txt")), "dear");
  }

  const std::vector<std::string> folder_commands_{"run corridor_short --gl off --duration 1",
                                                  "run corridor_short --gl off --set sensors.color.required=true",
                                                  "run corridor_short --robot emulated --gl off",
                                                  "run corridor_short --robot hardware:hardware.yaml",
                                                  "drive corridor_short --keyboard --gl off",
                                                  "camera pmd_3k_s --wall 2 --frames 1",
                                                  "camera pmd_3k_s --study noise"};
  const std::vector<std::string> file_commands_{"calibrate odometry --robot twin", "register cloud.csv cloud.csv",
                                                "optimize graph.g2o"};

 private:
  TemporaryFolder folder_;
  std::set<std::string> before_;
};

TEST_F(OutCli, RejectsAFolderInWhichNothingCanBeMade) {
  for (const std::vector<std::string>& commands : {folder_commands_, file_commands_})
    for (const std::string& command : commands)
      for (const std::string& out :
           {std::string("''"), std::string("/dev/full"), std::string("/dev/full/x"), std::string("file/below"),
            std::string("dangling"), std::string("/proc/merlin"), std::string(300, 'x')})
        ExpectRefused(command, out);
}

TEST_F(OutCli, RejectsAFileForAFolderAndAFolderForAFile) {
  for (const std::string& command : folder_commands_)
    for (const char* out : {"file", "mine"}) ExpectRefused(command, out);
  for (const std::string& command : file_commands_)
    for (const char* out : {"mine", "none/below", "mine/none/below"}) ExpectRefused(command, out);
}

TEST_F(OutCli, AStudyOfCalibrationWritesNoFile) { ExpectRefused("calibrate odometry --study", "c.yaml"); }

}  // namespace
}  // namespace merlin
