// `merlin calibrate` and `merlin bench physics` as users run them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

void ExpectUsageError(const std::string& arguments, const std::string& part, const std::filesystem::path& folder) {
  const Outcome outcome = Merlin(arguments, folder);
  EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.said;
  EXPECT_NE(outcome.said.find(part), std::string::npos) << arguments << "\n" << outcome.said;
}

TEST(CalibrateCli, RefusesToCalibrateFromNothingUsable) {
  const TemporaryFolder folder;
  ExpectUsageError("calibrate", "subcommand", folder.path());
  ExpectUsageError("calibrate odometry", "it needs one source of drives", folder.path());
  ExpectUsageError("calibrate odometry no.yaml --study", "several", folder.path());
  ExpectUsageError("calibrate odometry no.yaml", "no.yaml: cannot be read", folder.path());
  ExpectUsageError("calibrate odometry --robot moon", "--robot", folder.path());
  ExpectUsageError("calibrate odometry --robot twin --set car.drivetrain.wheel_radius=1", "wheel_radius_factor",
                   folder.path());
  ExpectUsageError("calibrate odometry --robot twin --set car.drivetrain.wheel_radius_factor=nan",
                   "wheel_radius_factor", folder.path());
  ExpectUsageError("calibrate odometry --robot twin --set car.drivetrain.surface=floor_ice", "floor_tiles",
                   folder.path());
  std::ofstream(folder.path() / "d.yaml") << "straights: [{encoder_counts: 74112, distance_m: 5.0}]\n"
                                             "circles: [{steering_rad: 0.2, diameter_m: 3.2}]\n";
  ExpectUsageError("calibrate odometry d.yaml", "d.yaml: too few drives", folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "calibration.yaml"));
  ExpectUsageError("run corridor_short --set car.calibration=no.yaml", "no.yaml: cannot be read", folder.path());
}

TEST(CalibrateCli, CalibratesTheTwinToAFileThatAScenarioTakes) {
  const TemporaryFolder folder;
  const Outcome outcome =
      Merlin("calibrate odometry --robot twin --set car.drivetrain.wheel_radius_factor=0.97", folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.said;
  const Outcome run = Merlin(
      "run corridor_short --gl off --duration 1 --set checks={} --set car.calibration=calibration.yaml "
      "--set car.drivetrain.wheel_radius_factor=0.97",
      folder.path());
  EXPECT_EQ(run.code, 0) << run.said;
}

TEST(BenchCli, TellsHowFastThePhysicsIs) {
  const TemporaryFolder folder;
  const Outcome outcome = Merlin("bench physics --json", folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.said;
  EXPECT_NE(outcome.said.find("\"times_real_time\": "), std::string::npos) << outcome.said;
}

}  // namespace
}  // namespace merlin
