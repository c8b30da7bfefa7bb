// Promises that all kinds of our YAML files share, tested for each kind. Materials: tests/sim/world/materials_test.cc.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "scenarios/config/calibration.h"
#include "scenarios/config/hardware_file.h"
#include "scenarios/config/names.h"
#include "scenarios/config/scenario.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

struct Kind {
  std::string name, good, key;  // key: one with a number, at the top level
  std::function<void(const std::filesystem::path&)> read;
};

// A mapping lies beside a car. The car is ours: its names follow the naming rule, so that an empty role is not an
// error.
void ReadMappingAt(const std::filesystem::path& file) {
  const std::filesystem::path urdf = file.parent_path() / "merlin.urdf";
  std::filesystem::copy_file(CarFile("merlin"), urdf, std::filesystem::copy_options::overwrite_existing);
  std::error_code there_already;
  std::filesystem::create_directory_symlink(CarFile("merlin").parent_path() / "meshes", file.parent_path() / "meshes",
                                            there_already);
  std::filesystem::copy_file(file, file.parent_path() / "merlin.mapping.yaml",
                             std::filesystem::copy_options::overwrite_existing);
  ReadCar(urdf);
}

std::vector<Kind> Kinds() {
  return {
      {"scenario", "room: hall\nduration_s: 3\n", "duration_s",
       [](const auto& file) { ReadScenario(file.string(), {}); }},
      {"depth sheet", Contents(CameraFile("pmd_3k_s")), "rate_max_hz",
       [](const auto& file) { ReadDepthCameraSheet(file); }},
      {"colour sheet", Contents(CameraFile("ccd")), "rate_max_hz",
       [](const auto& file) { ReadColorCameraSheet(file); }},
      {"calibration", ToYaml(CarCalibration{}), "wheelbase_m", [](const auto& file) { ReadCalibration(file); }},
      {"mapping", "steering_limit_rad: 0.3\n", "steering_limit_rad", ReadMappingAt},
      {"hardware file", "drive: {serial: {port: /dev/ttyS3}}\nclock: {watchdog_s: 1}\n", "clock",
       [](const auto& file) { ReadHardwareFile(file); }},
  };
}

// The reader's message about this text without the path; empty if there is none.
std::string Said(const Kind& kind, const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "f.yaml";
  std::ofstream(file, std::ios::binary) << text;
  try {
    kind.read(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

int LinesIn(const std::string& text) { return static_cast<int>(std::count(text.begin(), text.end(), '\n')); }

TEST(EveryKindOfYaml, IsReadWithAndWithoutAByteOrderMark) {
  for (const Kind& kind : Kinds())
    for (const std::string mark : {"", "\xEF\xBB\xBF"}) EXPECT_EQ(Said(kind, mark + kind.good), "") << kind.name;
}

TEST(EveryKindOfYaml, RefusesAKeyGivenTwiceAndAnUnknownOneTogether) {
  for (const Kind& kind : Kinds()) {
    const std::string said = Said(kind, kind.good + kind.key + ": {}\nwatever: 1\n");
    const int line = LinesIn(kind.good) + 1;
    EXPECT_NE(said.find(":" + std::to_string(line) + ": " + kind.key + ": given twice"), std::string::npos)
        << kind.name << ": " << said;
    EXPECT_NE(said.find(":" + std::to_string(line + 1) + ": watever: unknown key; did you mean '"), std::string::npos)
        << kind.name << ": " << said;
  }
}

TEST(EveryKindOfYaml, NamesTheLineOfBrokenYaml) {
  for (const Kind& kind : Kinds()) {
    const std::string said = Said(kind, kind.good + "x: {\n]\n");
    EXPECT_NE(said.find(":" + std::to_string(LinesIn(kind.good) + 2) + ": broken YAML: "), std::string::npos)
        << kind.name << ": " << said;
  }
}

TEST(EveryKindOfYaml, RefusesWhatHoldsNoMap) {
  for (const Kind& kind : Kinds())
    for (const std::string text : {"", "- a\n", "text\n"})
      EXPECT_NE(Said(kind, text).find("holds no map of keys; expected "), std::string::npos) << kind.name;
}

}  // namespace
}  // namespace merlin
