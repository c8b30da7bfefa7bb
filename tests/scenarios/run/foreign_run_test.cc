// Runs of a car that others described: notes for its user must reach the report.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "robot/base/error.h"
#include "scenarios/run/plugs.h"
#include "tests/robot/description/foreign_cars.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

std::atomic<bool> never{false};

std::string Without(std::string text, const std::string& line) { return text.erase(text.find(line), line.size()); }

// A rover without colour camera and compass, with its left kingpin 1.6 mm ahead of the right one.
void WriteBlindRover(const ForeignCar& files) {
  WriteRover(files);
  std::string urdf = RoverUrdf();
  const std::string pin = "xyz=\"0.3 0.17 -0.02\"";
  files.Write("car.urdf", urdf.replace(urdf.find(pin), pin.size(), "xyz=\"0.3016 0.17 -0.02\""));
  files.Write("car.mapping.yaml",
              Without(Without(kRoverMapping, "color_camera_optical_frame: eye\n"), "compass_frame: imu\n"));
}

RunReport Drive(const ForeignCar& files, const std::filesystem::path& out, const std::string& required) {
  const Scenario scenario = ReadScenario("corridor_short", {"car.model=" + files.urdf().string(), "duration_s=0.2",
                                                            "checks={}", "sensors.color.required=" + required});
  return RunScenario({.name = "foreign", .scenario = scenario, .out = out, .gl = Gl::kOff, .pace = 0.0, .progress = {}},
                     never);
}

TEST(ForeignRun, GoesWithoutTheSensorsThatTheCarLacksAndSaysSo) {
  const TemporaryFolder folder;
  const ForeignCar files;
  WriteBlindRover(files);
  const RunReport report = Drive(files, folder.path() / "run", "false");
  EXPECT_EQ(report.result.verdict, Verdict::kNotJudged);
  for (const char* says :
       {"the front wheels by 1.60 mm", "the car 'rover' has no colour camera", "the car 'rover' has no compass"})
    EXPECT_NE(report.note.find(says), std::string::npos) << report.note;
}

TEST(ForeignRun, RefusesACarWithoutTheColourCameraThatTheScenarioRequires) {
  const TemporaryFolder folder;
  const ForeignCar files;
  WriteBlindRover(files);
  try {
    Drive(files, folder.path() / "run", "true");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("sensors.color.required: the car 'rover' has no colour camera"),
              std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "run"));
}

}  // namespace
}  // namespace merlin
