#include "scenarios/config/hardware_file.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "robot/base/error.h"
#include "scenarios/config/hardware_check.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

// All keys of a tree with the keys above them, such as "drive.serial.port".
void Collect(const YAML::Node& node, const std::string& path, std::set<std::string>& keys) {
  for (const auto& entry : node) {
    const std::string key = path + entry.first.Scalar();
    keys.insert(key);
    if (entry.second.IsMap()) Collect(entry.second, key + ".", keys);
  }
}

std::set<std::string> Keys(const std::string& yaml) {
  std::set<std::string> keys;
  Collect(YAML::Load(yaml), "", keys);
  return keys;
}

HardwareConfig AllDevices() {
  HardwareConfig config;
  config.compass.emplace();
  config.color.emplace();
  return config;
}

TEST(HardwareExample, HasEveryKeyAndIsThisCars) {
  const fs::path file = fs::path(MERLIN_SOURCE_DIR) / "models/hardware/merlin.yaml";
  EXPECT_EQ(Keys(Contents(file)), Keys(ToYaml(AllDevices())));
  const HardwareConfig config = ReadHardwareFile(file);
  EXPECT_EQ(config.car, "merlin");
  EXPECT_EQ(config.drive.serial.baud, 57600);
  EXPECT_EQ(config.drive.command_rate_hz, MicrocontrollerConfig{}.command_rate_hz);
  RequireFits(config, ReadScenario("corridor_loop", {"sensors.color.required=true"}), file);
}

TEST(HardwareFile, SurvivesBeingWrittenOut) {
  const TemporaryFolder folder;
  HardwareConfig config = AllDevices();
  config.car = "rover";
  config.depth.pmd.source_argument = "a b: 'c' #d";
  for (const HardwareConfig& one : {config, HardwareConfig{}}) {
    std::ofstream(folder.path() / "car.yaml") << ToYaml(one);
    EXPECT_EQ(ToYaml(ReadHardwareFile(folder.path() / "car.yaml")), ToYaml(one));
  }
}

std::string FitComplaint(const fs::path& file, const std::string& yaml, const std::vector<std::string>& sets = {}) {
  std::ofstream(file) << yaml;
  try {
    RequireFits(ReadHardwareFile(file), ReadScenario("corridor_short", sets), file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(HardwareFile, MayNotNameADeviceTwice) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "car.yaml";
  const std::string two = FitComplaint(file, "drive: {serial: {port: /dev/x}}\ncompass: {serial: {port: /dev/x}}\n");
  EXPECT_NE(two.find("car.yaml: names a device twice"), std::string::npos) << two;
  EXPECT_NE(two.find("drive and compass"), std::string::npos) << two;
  // The same port under another name.
  std::ofstream(folder.path() / "port") << "";
  fs::create_symlink(folder.path() / "port", folder.path() / "link");
  const std::string port = (folder.path() / "port").string(), link = (folder.path() / "link").string();
  const std::string linked =
      FitComplaint(file, "drive: {serial: {port: " + port + "}}\ncolor: {source: " + link + "}\n");
  EXPECT_NE(linked.find("drive and color"), std::string::npos) << linked;
  // A key twice.
  const std::string again = FitComplaint(file, "drive: {serial: {port: /dev/x}}\ndrive: {serial: {port: /dev/y}}\n");
  EXPECT_NE(again.find("drive: given twice"), std::string::npos) << again;
  EXPECT_EQ(FitComplaint(file, "drive: {serial: {port: /dev/x}}\ncompass: {serial: {port: /dev/y}}\n"), "");
}

TEST(HardwareFile, OfAnotherCarIsRefused) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "car.yaml";
  const std::string other = FitComplaint(file, "car: rover\n");
  EXPECT_NE(other.find("the devices of another car"), std::string::npos) << other;
  EXPECT_NE(other.find("expected 'merlin'"), std::string::npos) << other;
  EXPECT_NE(other.find("got 'rover'"), std::string::npos) << other;
  EXPECT_EQ(FitComplaint(file, "car: merlin\n"), "");
  EXPECT_EQ(FitComplaint(file, "clock: {watchdog_s: 1}\n"), "");  // does not name a car
}

TEST(HardwareFile, MustNameTheColorCameraThatTheScenarioRequires) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "car.yaml";
  const std::string none = FitComplaint(file, "car: merlin\n", {"sensors.color.required=true"});
  EXPECT_NE(none.find("no colour camera"), std::string::npos) << none;
  EXPECT_EQ(FitComplaint(file, "color: {source: /dev/video1}\n", {"sensors.color.required=true"}), "");
}

}  // namespace
}  // namespace merlin
