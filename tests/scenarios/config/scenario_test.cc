#include "scenarios/config/scenario.h"

#include <gtest/gtest.h>

#include <fstream>

#include "robot/base/error.h"
#include "scenarios/config/names.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

// The error message for a scenario with this text; empty if it is accepted.
std::string Complaint(const std::string& text, const std::vector<std::string>& sets = {}) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << text;
  try {
    ReadScenario(file.string(), sets);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool Has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Scenario, OursAreValidAndSurviveBeingWrittenOut) {
  ASSERT_GE(ScenarioNames().size(), 3u);
  for (const std::string& name : ScenarioNames()) {
    const std::string text = ToYaml(ReadScenario(name, {}));
    const TemporaryFolder folder;
    const auto file = folder.path() / "again.yaml";
    std::ofstream(file) << text;
    EXPECT_EQ(ToYaml(ReadScenario(file.string(), {})), text) << name;
  }
}

TEST(Scenario, NamesTheNearestForUnknownNames) {
  const auto message = [](auto call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(Has(message([] { ReadScenario("coridor_loop", {}); }), "'corridor_loop'"));
  EXPECT_TRUE(Has(message([] { RoomFile("corridor_26"); }), "'corridor_26x21'"));
  EXPECT_TRUE(Has(message([] { CameraFile("pmd_3ks"); }), "'pmd_3k_s'"));
  EXPECT_TRUE(Has(message([] { CameraFile("ccb"); }), "did you mean 'ccd'"));
  EXPECT_TRUE(Has(message([] { DepthCameraFile("ccb"); }), "unknown depth camera 'ccb'; did you mean 'camcube_2'"));
  EXPECT_TRUE(Has(message([] { ColorCameraFile("pmd_3ks"); }), "unknown colour camera 'pmd_3ks'; did you mean 'ccd'"));
  EXPECT_TRUE(Has(message([] { ScenarioFile("/no/such.yaml"); }), "/no/such.yaml"));
}

TEST(Scenario, NamesUnknownKeysWithLineAndTheNearest) {
  const std::string said = Complaint("room: hall\nsensors:\n  depth: {rate_herz: 20}\nduraton_s: 3\n");
  EXPECT_TRUE(Has(said, "s.yaml:3: sensors.depth.rate_herz: unknown key; did you mean 'rate_hz'?")) << said;
  EXPECT_TRUE(Has(said, "s.yaml:4: duraton_s: unknown key; did you mean 'duration_s'?")) << said;
}

TEST(Scenario, TakesTheFormerNameOfABehaviorWithAWarning) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "room: hall\ntask: {behavior: turn_on_stand, angle_deg: 90}\n";
  const Scenario scenario = ReadScenario(file.string(), {});
  EXPECT_EQ(scenario.task.behavior, "turn_on_turntable");
  ASSERT_EQ(scenario.warnings.size(), 1u);
  EXPECT_TRUE(Has(scenario.warnings[0], "'turn_on_stand' is now called 'turn_on_turntable'")) << scenario.warnings[0];
  EXPECT_TRUE(ReadScenario("room_turn_180", {}).warnings.empty());
}

TEST(Scenario, ReportsEveryValueOutOfRangeAtOnce) {
  const std::string said = Complaint(
      "room: hall\nduration_s: -1\nsensors: {depth: {rate_hz: .nan}}\nseed: -4\ntask: {laps: 1.5}\npilot: {speed_m_s: "
      "9}\n");
  for (const char* field :
       {":2: duration_s", ":3: sensors.depth.rate_hz", ":4: seed", ":5: task.laps", ":6: pilot.speed_m_s"})
    EXPECT_TRUE(Has(said, field)) << field << " in: " << said;
  EXPECT_TRUE(Has(said, "[0.05, 2], got '9'")) << said;
}

TEST(Scenario, TellsWhatIsWrongWithTheFile) {
  EXPECT_TRUE(Has(Complaint("room: [hall\n"), "s.yaml:2: broken YAML"));
  EXPECT_TRUE(Has(Complaint(""), "holds no map of keys; expected a scenario"));
  EXPECT_TRUE(Has(Complaint("- a\n"), "holds no map of keys; expected a scenario"));
  EXPECT_TRUE(Has(Complaint("seed: 1\n"), "s.yaml:1: missing key 'room'"));
  EXPECT_TRUE(Has(Complaint("room: hall\ncar: 5\n"), "s.yaml:2: car: expected a map"));
  EXPECT_TRUE(Has(Complaint("room: hall\nchecks: {collision_max: 0}\n"), "collisions_max"));
  EXPECT_TRUE(Has(Complaint("room: hall\ntask: {behavior: follow_coridor}\n"),
                  "s.yaml:2: task.behavior: unknown behavior 'follow_coridor'; did you mean 'follow_corridor'?"));
  EXPECT_TRUE(Has(Complaint("room: hall\nobstacles:\n  - {}\n  - {appear_s: 5,\n     disappear_s: 5}\n"),
                  "s.yaml:5: obstacles[1].disappear_s: expected a time after its appear_s"));
  EXPECT_TRUE(
      Has(Complaint("room: hall\nchecks: {laps_min: 1, laps_min: 2}\n"), "s.yaml:2: checks.laps_min: given twice"));
}

TEST(Scenario, TakesNumbersAsTypedAndNoKeyTwice) {
  EXPECT_TRUE(Has(Complaint("room: hall\nseed: 0x10\n"), "whole number"));
  EXPECT_TRUE(Has(Complaint("room: hall\nseed: 1\nseed: 2\n"), "s.yaml:3: seed: given twice"));
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "room: hall\nseed: 010\n";
  EXPECT_EQ(ReadScenario(file.string(), {}).seed, 10u);
}

TEST(Scenario, KnowsAnOpenAndAClosedCurtain) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "room: hall\n";
  EXPECT_EQ(ReadScenario(file.string(), {}).curtain, "open");
  EXPECT_EQ(ReadScenario(file.string(), {"curtain=closed"}).curtain, "closed");
  EXPECT_TRUE(Has(ToYaml(ReadScenario(file.string(), {"curtain=closed"})), "curtain: closed"));
  EXPECT_TRUE(Has(Complaint("room: hall\ncurtain: shut\n"), "s.yaml:2: curtain: expected open or closed, got 'shut'"));
  EXPECT_TRUE(Has(Complaint("room: hall\ncurtain: [open]\n"), "s.yaml:2: curtain: expected a text"));
}

TEST(Scenario, TakesAnIntegrationTimeOrLeavesItToTheStack) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "room: hall\nsensors: {depth: {integration_us: 700}}\n";
  const Scenario fixed = ReadScenario(file.string(), {});
  EXPECT_EQ(fixed.sensors.depth.integration_us.us, 700.0);
  EXPECT_FALSE(fixed.perception.integration.automatic);
  const Scenario automatic = ReadScenario(file.string(), {"sensors.depth.integration_us=auto"});
  EXPECT_FALSE(automatic.sensors.depth.integration_us.us);
  EXPECT_TRUE(automatic.perception.integration.automatic);
  EXPECT_TRUE(Has(ToYaml(automatic), "integration_us: auto"));
  std::ofstream(file) << "room: hall\n";
  EXPECT_TRUE(ReadScenario(file.string(), {}).perception.integration.automatic);
}

TEST(Scenario, RejectsABadIntegrationTime) {
  const auto said = [](const std::string& time) {
    return Complaint("room: hall\nsensors:\n  depth: {integration_us: " + time + "}\n");
  };
  for (const char* time : {"atuo", "[1000]", "0x"})
    EXPECT_TRUE(Has(said(time), "s.yaml:3: sensors.depth.integration_us: expected auto, or a number of microseconds"))
        << said(time);
  for (const char* time : {"0", "-1000", ".nan", "1e7"})
    EXPECT_TRUE(Has(said(time), "s.yaml:3: sensors.depth.integration_us: expected a number in")) << said(time);
  EXPECT_TRUE(Has(Complaint("room: hall\nperception: {integration: {adapt: true}}\n"),
                  "s.yaml:2: perception.integration.adapt: is gone: write sensors.depth.integration_us: auto"));
}

TEST(Scenario, FindsFilesBesideItselfFromAnyFolder) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "my_room.xml") << "<mujoco/>";
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "room: ./my_room.xml\n";
  EXPECT_EQ(ReadScenario(file.string(), {}).room, (folder.path() / "my_room.xml").string());
}

TEST(Scenario, SetsOverrideTheFileAndAreCheckedAlike) {
  EXPECT_EQ(Complaint("room: hall\n", {"pilot.speed_m_s=0.3", "sensors.compass.rate_hz=5"}), "");
  EXPECT_TRUE(Has(Complaint("room: hall\n", {"pilot.sped_m_s=0.3"}), "did you mean 'speed_m_s'?"));
  EXPECT_TRUE(Has(Complaint("room: hall\n", {"pilot.speed_m_s=fast"}),
                  "--set: pilot.speed_m_s: expected a number in [0.05, 2], got 'fast'"));
  EXPECT_TRUE(Has(Complaint("room: hall\n", {"pilot"}), "not an assignment"));
  EXPECT_TRUE(Has(Complaint("room: hall\nseed: 3\n", {"seed.x=1"}), "has no keys below it"));
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "room: hall\nseed: 3\n";
  EXPECT_EQ(ReadScenario(file.string(), {"seed=7"}).seed, 7u);
  EXPECT_EQ(ReadScenario(file.string(), {}).seed, 3u);
}

TEST(Scenario, FindsAMapBesideItsFileAndOneThatIsSetFromWhereItIsStarted) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "room: hall\nmap: runs/a/map.slam\n";
  EXPECT_EQ(ReadScenario(file.string(), {}).map, "runs/a/map.slam") << "no such file yet";
  std::filesystem::create_directories(folder.path() / "runs/a");
  std::ofstream(folder.path() / "runs/a/map.slam") << "a map";
  EXPECT_EQ(ReadScenario(file.string(), {}).map, (folder.path() / "runs/a/map.slam").string());
  EXPECT_EQ(ReadScenario(file.string(), {"map=runs/a/map.slam"}).map, "runs/a/map.slam");
}

}  // namespace
}  // namespace merlin
