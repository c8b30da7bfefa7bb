// The twin in place of the car, end to end: one program serves the simulated car's devices; another program, which
// links no simulation, drives them as it would drive the real ones.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "scenarios/judge/alignment.h"
#include "scenarios/judge/tum_file.h"
#include "tests/support/program.h"
#include "tests/support/until.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Without colour, because software rendering beside two programs would overload a slow machine.
class TwoPrograms : public testing::Test {
 protected:
  TwoPrograms()
      : emulator_("emulator", MERLIN_BINARY,
                  {"emulate", "corridor_short", "--gl", "off", "--hardware-file", "car.yaml", "--out", "truth.tum"},
                  folder_.path()) {}

  void SetUp() override {
    ASSERT_TRUE(Until([&] { return fs::exists(folder_.path() / "car.yaml"); })) << emulator_.Said();
  }

  std::unique_ptr<Program> Drive(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"run", "corridor_short", "--robot", "hardware:car.yaml", "--out", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return std::make_unique<Program>(out, MERLIN_NO_TWIN_BINARY, arguments, folder_.path());
  }
  Json Result(const std::string& out) const { return Json::parse(Contents(folder_.path() / out / "result.json")); }
  Trajectory Truth() const { return ParseTum(Contents(folder_.path() / "truth.tum"), "truth.tum").trajectory; }
  // The time [s] of the simulated world at which the emulator said this; negative if it did not.
  double TimeOf(const std::string& text) const {
    std::smatch match;
    const std::string said = emulator_.Said();
    return std::regex_search(said, match, std::regex("([0-9.]+) s: " + text)) ? std::stod(match[1]) : -1.0;
  }

  TemporaryFolder folder_;
  Program emulator_;
};

TEST_F(TwoPrograms, DriveAndServeTheCarAndAgreeOnItsPath) {
  const auto driver = Drive("drive");
  EXPECT_EQ(driver->Wait(), 0) << driver->Said() << emulator_.Said();
  const Json result = Result("drive");
  EXPECT_EQ(result["verdict"], "pass");
  for (const Json& check : result["checks"]) {
    const bool judged = check["name"] == "distance_m_min";
    EXPECT_EQ(check["pass"], judged ? Json(true) : Json()) << check;
  }
  EXPECT_TRUE(result["metrics"]["collisions"].is_null());
  EXPECT_GT(result["metrics"]["stack_rss_mb"].get<double>(), 1.0);
  EXPECT_TRUE(driver->HasSaid("not judged: collisions_max")) << driver->Said();
  EXPECT_NE(Contents(folder_.path() / "drive/junit.xml").find("<skipped"), std::string::npos);

  ASSERT_TRUE(Until([&] { return emulator_.HasSaid("the car stands"); })) << emulator_.Said();
  emulator_.Signal(SIGINT);
  EXPECT_EQ(emulator_.Wait(), 130);
  EXPECT_FALSE(fs::exists(folder_.path() / "car.yaml"));
  EXPECT_TRUE(emulator_.HasSaid(", 0 collisions")) << emulator_.Said();
  const double true_m = PathLength_m(Truth()), odometry_m = result["metrics"]["distance_m"];
  EXPECT_GE(odometry_m, 8.0);
  EXPECT_NEAR(odometry_m, true_m, 0.05 * true_m);
}

TEST_F(TwoPrograms, TheCarStandsWhenItsDriverIsKilledAndTheNextOneDrivesIt) {
  const auto killed = Drive("killed");
  ASSERT_TRUE(Until([&] { return killed->HasSaid("follows the corridor"); })) << killed->Said();
  killed->Signal(SIGKILL);
  ASSERT_TRUE(Until([&] { return emulator_.HasSaid("the car stands"); })) << emulator_.Said();
  EXPECT_EQ(killed->Wait(), 128 + SIGKILL);
  const double gone_s = TimeOf("the driving program has gone"), stands_s = TimeOf("the car stands");
  EXPECT_LE(stands_s - gone_s, 1.0) << emulator_.Said();  // the last command's rest, 0.2 s, v / (2 m/s^2), two looks

  const auto next = Drive("next", {"--duration", "2", "--set", "checks={}"});
  EXPECT_EQ(next->Wait(), 0) << next->Said();
  EXPECT_EQ(Result("next")["verdict"], "not judged");
  emulator_.Signal(SIGTERM);
  EXPECT_EQ(emulator_.Wait(), 130);
  EXPECT_GT(PathLength_m(Truth()), 1.0);  // it did drive
}

TEST_F(TwoPrograms, TheDriverNamesTheDeviceThatHasGoneWithTheEmulator) {
  const auto driver = Drive("drive");
  ASSERT_TRUE(
      Until([&] { return emulator_.HasSaid("a program drives the car") && fs::exists(folder_.path() / "drive"); }));
  const std::string hardware = Contents(folder_.path() / "car.yaml");
  std::smatch port;
  ASSERT_TRUE(std::regex_search(hardware, port, std::regex("port: (\\S+)"))) << hardware;
  emulator_.Signal(SIGKILL);
  const auto killed = std::chrono::steady_clock::now();
  EXPECT_EQ(driver->Wait(), 1) << driver->Said();
  // One second to notice, plus the time for judging. This promise is about wall-clock time.
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - killed).count(), 3.0);
  EXPECT_TRUE(driver->HasSaid("microcontroller on " + port[1].str() + ": the port has gone")) << driver->Said();
  EXPECT_TRUE(driver->HasSaid("depth.socket")) << driver->Said();  // whether or not it still exists
  EXPECT_EQ(Result("drive")["verdict"], "fail");
  EXPECT_NE(Result("drive")["fault"].get<std::string>().find("the port has gone"), std::string::npos);
}

}  // namespace
}  // namespace merlin
