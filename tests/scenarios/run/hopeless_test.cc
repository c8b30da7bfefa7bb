// Runs that cannot succeed say so within 20 s, and why: a camera that cannot map, settings in which nothing is
// measured, a room without anything to hold on to, a car that is blocked.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/run/plugs.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

std::atomic<bool> never_hopeless{false};

class HopelessRun : public testing::Test {
 protected:
  // The scenario of a lap, on a bare floor with walls around it; each test changes some of its settings.
  RunReport Run(std::vector<std::string> sets, const std::string& room = kWalls) {
    std::ofstream(folder_.path() / "room.xml") << "<mujoco><worldbody>" << room << "</worldbody></mujoco>";
    for (const char* set :
         {"sensors.color=null", "car.start={x_m: 0, y_m: 0, yaw_rad: 0}", "checks={}", "duration_s=40"})
      sets.emplace_back(set);
    sets.push_back("room=" + (folder_.path() / "room.xml").string());
    RunOptions options;
    options.name = "hopeless";
    options.scenario = ReadScenario("corridor_short", sets);
    options.out = folder_.path() / "run";
    options.gl = Gl::kOff;
    return RunScenario(options, never_hopeless);
  }
  std::string Camera(const std::string& change, const std::string& to) {
    std::string sheet = Contents(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/pmd_3k_s.yaml");
    for (std::size_t at = 0, end = 0; end < change.size(); at = end + 1) {
      end = std::min(change.find(',', at), change.size());
      const std::string key = change.substr(at, end - at) + ":";
      const std::size_t line = sheet.find("\n" + key) + 1;
      sheet.replace(line, sheet.find('\n', line) - line, key + " " + to);
    }
    std::ofstream(folder_.path() / "camera.yaml") << sheet;
    return "sensors.depth.camera=" + (folder_.path() / "camera.yaml").string();
  }
  static void ExpectEndsSaying(const RunReport& report, const std::string& reason) {
    EXPECT_EQ(report.result.verdict, Verdict::kFail);
    EXPECT_FALSE(report.error);
    EXPECT_NE(report.result.fault.find(reason), std::string::npos) << report.result.fault;
    EXPECT_LE(report.result.metrics.sim_time_s.value_or(99.0), 20.0);
    EXPECT_EQ(report.result.metrics.collisions.value_or(1), 0);
  }

  static constexpr char kFloor[] = R"(<geom name="floor" type="plane" size="60 60 1"/>)";
  static constexpr char kWalls[] = R"(<geom name="floor" type="plane" size="60 60 1"/>
    <geom type="box" size="20 .1 1" pos="0 1.1 1"/> <geom type="box" size="20 .1 1" pos="0 -1.1 1"/>)";
  const TemporaryFolder folder_;
};

TEST_F(HopelessRun, WithOnePixelRow) { ExpectEndsSaying(Run({Camera("height_px", "1")}), "the car"); }

TEST_F(HopelessRun, WithAViewOfTwoDegrees) {
  ExpectEndsSaying(Run({Camera("fov_horizontal_deg,fov_vertical_deg", "2")}), "the car");
}

TEST_F(HopelessRun, WhereEveryPixelSaturates) {
  ExpectEndsSaying(Run({Camera("full_well_e", "500")}), "pixels are saturated");
}

TEST_F(HopelessRun, WhereNoPixelGetsAReturn) {
  ExpectEndsSaying(Run({Camera("signal_e_m2_per_us", "0.01")}), "pixels get no return");
}

TEST_F(HopelessRun, WhereThereIsOnlyAFloor) { ExpectEndsSaying(Run({}, kFloor), "hold on to"); }

// It drives for two seconds, waits for six, backs, and waits for the other nine.
TEST_F(HopelessRun, BehindAnObstacleThatStays) {
  RunOptions options;
  options.name = "blocked";
  options.scenario = ReadScenario(
      "corridor_short",
      {"sensors.color=null", "duration_s=40",
       "obstacles=[{appear_s: 1, disappear_s: 100, ahead_m: 1.5, length_m: 0.4, width_m: 0.4, height_m: 0.5, material: "
       "dark_box}]"});
  options.out = folder_.path() / "run";
  options.gl = Gl::kOff;
  const RunReport report = RunScenario(options, never_hopeless);
  EXPECT_EQ(report.result.verdict, Verdict::kFail);
  EXPECT_NE(report.result.fault.find("an obstacle is 0."), std::string::npos) << report.result.fault;
  EXPECT_LE(report.result.metrics.sim_time_s.value_or(99.0), 27.0);
  EXPECT_EQ(report.result.metrics.collisions.value_or(1), 0);
}

}  // namespace
}  // namespace merlin
