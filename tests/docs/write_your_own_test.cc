// The examples of docs/write-your-own.md do what the page says, and the page quotes them as they are.
#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include "docs/examples/behavior/drive_straight.h"
#include "docs/examples/driver/text_compass.h"
#include "robot/emulated/pseudo_terminal.h"
#include "tests/autonomy/car.h"
#include "tests/autonomy/drive_in_walls.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/until.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

const std::string kRoot = MERLIN_SOURCE_DIR;

void ExpectRuns(const std::string& arguments, int code = 0) {
  const TemporaryFolder folder;
  const Outcome outcome = Merlin(arguments + " --out run", folder.path());
  EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.said;
}

// Each quotation is a fenced block whose first line names the file; the other lines are in that file as they are here.
TEST(WriteYourOwn, QuotesTheExamplesAsTheyAre) {
  std::istringstream page(Contents(kRoot + "/docs/write-your-own.md"));
  int quoted = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("```")) continue;
    std::string name, block, text;
    std::getline(page, name);
    while (std::getline(page, text) && !text.starts_with("```")) block += text + "\n";
    const std::size_t from = name.find("docs/examples/");
    ASSERT_NE(from, std::string::npos) << name;
    const std::string file = name.substr(from, name.find_first_of(" \n", from) - from);
    EXPECT_NE(Contents(kRoot + "/" + file).find(block), std::string::npos) << file << " does not hold:\n" << block;
    ++quoted;
  }
  EXPECT_GE(quoted, 7);
}

TEST(WriteYourOwn, TheRoomIsDrivenAndJudged) {
  ExpectRuns("run " + kRoot + "/docs/examples/room/scenario.yaml --gl off");
}

TEST(WriteYourOwn, TheCameraLooksAtAWallAndDrives) {
  const std::string camera = kRoot + "/docs/examples/camera/camera.yaml";
  ExpectRuns("camera " + camera + " --wall 2 --frames 3");
  ExpectRuns("run corridor_short --gl off --duration 2 --set checks={} --set sensors.depth.camera=" + camera);
}

TEST(WriteYourOwn, TheCarDrives) {
  ExpectRuns(
      "run corridor_short --gl off --duration 4 --set 'checks={collisions_max: 0, distance_m_min: 0.5}' --set "
      "car.model=" +
      kRoot + "/docs/examples/car/cart.urdf");
}

TEST(WriteYourOwn, TheBehaviourDrivesStraightAndStops) {
  Walls walls(0.0);
  walls.Add(-3.0, 1.0, 9.0, 1.0);
  walls.Add(-3.0, -1.0, 9.0, -1.0);
  DriveInWalls drive(walls);
  Pilot pilot(Car(),
              [behavior = DriveStraight({.length_m = 1.5})](const Situation& s) mutable { return behavior.Decide(s); },
              {});
  EXPECT_EQ(drive.Drive(pilot, 200), (std::vector{Activity::kFollowsPath, Activity::kIsDone}));
  EXPECT_TRUE(drive.decision.done);
  EXPECT_EQ(drive.decision.command.speed_m_s, 0.0);
  EXPECT_NEAR(drive.car.x_m, 1.5, 0.05);
  EXPECT_NEAR(drive.car.y_m, 0.0, 0.01);
}

class TextCompassLine : public testing::Test {
 protected:
  void Say(const std::string& text) {
    now_ += std::chrono::milliseconds(100);
    end_.Receive(now_, BytesView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }
  Time now_{0};
  TextCompassEnd end_{{.serial = {.port = "none", .baud = 9600}, .north_yaw_rad = 0.5, .silent_after_s = 0.5}};
};

TEST_F(TextCompassLine, TurnsHeadingsIntoYawInTheBodysAxes) {
  end_.Connected(now_);
  Say("$ATT,90,10,-5\n");
  const auto reading = end_.readings.Take();
  ASSERT_TRUE(reading);
  EXPECT_NEAR(reading->yaw_rad, 0.5 - std::numbers::pi / 2.0, 1e-12);
  EXPECT_NEAR(reading->roll_rad, std::numbers::pi / 18.0, 1e-12);
  EXPECT_NEAR(reading->pitch_rad, std::numbers::pi / 36.0, 1e-12);
  EXPECT_LT(reading->stamp, now_);
  EXPECT_EQ(end_.status().health, DeviceStatus::Health::kOk);
  Say("$ATT,350,0,0\n");
  EXPECT_NEAR(end_.readings.Take()->yaw_rad, 0.5 + std::numbers::pi / 18.0, 1e-12);
}

TEST_F(TextCompassLine, TakesLinesThatComeInPiecesAndCountsGarbage) {
  end_.Connected(now_);
  Say("$ATT,0,");
  EXPECT_FALSE(end_.readings.Take());
  Say("0,0\n$ATT,0,0\n$ATT,nan,0,0\nhello\n");
  EXPECT_TRUE(end_.readings.Take());
  EXPECT_FALSE(end_.readings.Take());
  EXPECT_EQ(end_.status().garbage, 3u);
  Say(std::string(1000, 'x'));  // no line without end
  EXPECT_GT(end_.status().garbage, 3u);
}

TEST_F(TextCompassLine, FallsSilentAndComesBack) {
  end_.Connected(now_);
  EXPECT_EQ(end_.status().health, DeviceStatus::Health::kSilent);
  Say("$ATT,0,0,0\n");
  EXPECT_EQ(end_.status().health, DeviceStatus::Health::kOk);
  for (int i = 0; i < 6; ++i) Say("");
  EXPECT_EQ(end_.status().health, DeviceStatus::Health::kSilent);
  Say("$ATT,0,0,0\n");
  EXPECT_EQ(end_.status().health, DeviceStatus::Health::kOk);
  end_.Disconnected(now_);
  EXPECT_EQ(end_.status().health, DeviceStatus::Health::kAbsent);
}

TEST(WriteYourOwn, TheDriverReadsItsPort) {
  PseudoTerminal terminal;
  const HandClock clock;
  TextCompass compass({.serial = {.port = terminal.path(), .baud = 9600}}, clock);
  const std::string line = "$ATT,90,0,0\n";
  terminal.Write(BytesView(reinterpret_cast<const std::uint8_t*>(line.data()), line.size()));
  std::optional<CompassReading> reading;
  ASSERT_TRUE(Until([&] { return (reading = compass.Poll()).has_value(); }));
  EXPECT_NEAR(reading->yaw_rad, -std::numbers::pi / 2.0, 1e-12);
  EXPECT_EQ(compass.Status().delivered, 1u);
}

}  // namespace
}  // namespace merlin
