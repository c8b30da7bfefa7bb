// Whole runs over the real drivers and protocols, in real time.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "robot/base/error.h"
#include "scenarios/config/hardware_file.h"
#include "scenarios/run/plugs.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

std::atomic<bool> never{false};

RunReport Drive(RobotKind robot, const std::filesystem::path& out, const std::vector<std::string>& sets = {}) {
  return RunScenario({.name = "corridor_short",
                      .scenario = ReadScenario("corridor_short", sets),
                      .out = out,
                      .robot = robot,
                      .hardware_file = {},
                      .gl = Gl::kOff,  // software rendering beside the run would overload a slow machine
                      .threads = 2,
                      .pace = 0.0,
                      .progress = {}},
                     never);
}

TEST(EmulatedRobot, DrivesTheCorridorWithTheVerdictOfTheTwin) {
  const TemporaryFolder folder;
  const RunReport twin = Drive(RobotKind::kTwin, folder.path() / "twin");
  const RunReport emulated = Drive(RobotKind::kEmulated, folder.path() / "emulated");
  EXPECT_EQ(emulated.result.verdict, twin.result.verdict) << emulated.note;
  EXPECT_EQ(emulated.result.verdict, Verdict::kPass) << emulated.note;
  EXPECT_NEAR(*emulated.result.metrics.distance_m, *twin.result.metrics.distance_m, 2.0);
  EXPECT_LT(*emulated.result.metrics.ate_rmse_m, 0.2);
  EXPECT_FALSE(emulated.result.hashes.state);  // real time: not the same bits twice
}

TEST(EmulatedRobot, SaysThatTheCamerasLibraryIsMissingBeforeAnythingMoves) {
  const TemporaryFolder folder;
  setenv("MERLIN_PMD_LIBRARY", "/no/such/libpmd.so", 1);
  try {
    Drive(RobotKind::kEmulated, folder.path() / "run");
    ADD_FAILURE() << "ran without a library";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/libpmd.so"), std::string::npos) << error.what();
  }
  unsetenv("MERLIN_PMD_LIBRARY");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "run"));
}

// 48 x 64 pixels, forty frames, then exceptions.
TEST(EmulatedRobot, StandsAndTellsWhyWhenTheCamerasLibraryThrows) {
  const TemporaryFolder folder;
  setenv("MERLIN_PMD_LIBRARY", THROWING_PMD_LIBRARY, 1);
  setenv("MERLIN_THROWING_PMD", "64x48x60", 1);
  const RunReport report = Drive(RobotKind::kEmulated, folder.path() / "run", {"duration_s=15"});
  unsetenv("MERLIN_PMD_LIBRARY");
  EXPECT_EQ(report.result.verdict, Verdict::kFail);
  EXPECT_FALSE(report.error);
  EXPECT_NE(report.result.fault.find("the depth camera has been silent for "), std::string::npos)
      << report.result.fault;
  EXPECT_NE(report.result.fault.find("the lamp has burnt out"), std::string::npos) << report.result.fault;
  EXPECT_NE(Contents(folder.path() / "run/result.json").find("the lamp has burnt out"), std::string::npos);
}

std::string Complaint(const std::filesystem::path& file, const std::string& yaml) {
  std::ofstream(file) << yaml;
  try {
    ReadHardwareFile(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(HardwareFile, ReportsEveryFaultWithItsLine) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "car.yaml";
  EXPECT_EQ(Complaint(file, "drive: {serial: {port: /dev/ttyS3, baud: 115200}}\ncolor: {source: /dev/video1}\n"), "");
  EXPECT_EQ(ReadHardwareFile(file).drive.serial.port, "/dev/ttyS3");
  EXPECT_EQ(ReadHardwareFile(file).color->source, "/dev/video1");
  EXPECT_FALSE(ReadHardwareFile(file).compass);
  const std::string said = Complaint(file, "drive: {serial: {prot: x}}\nclock: {watchdog_s: 900}\n");
  EXPECT_NE(said.find(":1: drive.serial.prot: unknown key; did you mean 'port'?"), std::string::npos) << said;
  EXPECT_NE(said.find(":2: clock.watchdog_s: expected a number in [0.05, 60], got '900'"), std::string::npos) << said;
  EXPECT_NE(Complaint(file, "drive: [").find("car.yaml:"), std::string::npos);
  EXPECT_THROW(ReadHardwareFile(folder.path() / "none.yaml"), InputError);
}

// Every faulty device is reported; none hides another.
TEST(HardwareDevices, AreEachToldByName) {
  HardwareConfig config;
  config.drive.serial.port = "/dev/merlin-none-1";
  config.compass.emplace().serial.port = "/dev/merlin-none-2";
  config.depth.pmd.library = "/no/libpmd.so";
  const auto reports =
      CheckDevices(config, CamerasOf(ReadScenario("corridor_short", {})), std::chrono::milliseconds(10));
  ASSERT_EQ(reports.size(), 3u);
  EXPECT_NE(reports[0].complaint.find("/dev/merlin-none-1"), std::string::npos) << reports[0].complaint;
  EXPECT_NE(reports[1].complaint.find("/dev/merlin-none-2"), std::string::npos) << reports[1].complaint;
  EXPECT_NE(reports[2].complaint.find("/no/libpmd.so"), std::string::npos) << reports[2].complaint;
}

}  // namespace
}  // namespace merlin
