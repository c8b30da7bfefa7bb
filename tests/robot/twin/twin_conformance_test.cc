// The twin against the conformance suite, and what only a simulated robot can promise.
#include <gtest/gtest.h>

#include <filesystem>

#include "robot/base/error.h"
#include "tests/robot/hal/merlin_before_wall.h"

namespace merlin {
namespace {

TwinOptions Options(const sim::TemporaryFile& room) {
  TwinOptions options = MerlinIn(room);
  options.end = std::chrono::hours(1);
  options.threads = 1;
  return options;
}

// A small picture of the usual view, through the usual lens.
TwinOptions::Color SmallColor() {
  TwinOptions::Color color;
  color.sheet = ReadColorCameraSheet(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/ccd.yaml");
  CameraModel& camera = color.sheet.camera;
  camera.width /= 8, camera.height /= 8;
  for (double* px : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px}) *px /= 8.0;
  return color;
}

// With colour where this machine can draw.
TwinOptions WithColor(TwinOptions options) {
  options.color = SmallColor();
  try {
    const Twin twin(options);
  } catch (const MachineError&) {
    options.color.reset();
  }
  return options;
}

class RiggedTwin final : public MerlinBeforeWall {
 public:
  RiggedTwin() : twin_(WithColor(Options(room_))) {}
  Robot robot() override { return twin_.robot(); }

 private:
  Twin twin_;
};

INSTANTIATE_TEST_SUITE_P(Twin, HalConformance,
                         ::testing::Values(Plug{"twin", [] { return std::make_unique<RiggedTwin>(); }}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Twin, GivesTheSameFramesForAnyNumberOfThreads) {
  std::vector<DepthFrame> first;
  for (const int threads : {1, 2, 3}) {
    const sim::TemporaryFile room("room.xml", sim::Room(kRoomWithWall));
    TwinOptions options = Options(room);
    options.threads = threads;
    Twin twin(options);
    Robot robot = twin.robot();
    std::vector<DepthFrame> frames;
    robot.drive->Send({.speed_m_s = 0.5, .steering_rad = 0.1, .valid_for = std::chrono::seconds(10)});
    while (frames.size() < 10) {
      ASSERT_TRUE(robot.clock->WaitUntil(robot.clock->Now() + std::chrono::milliseconds(50)));
      while (auto frame = robot.depth->Poll()) frames.push_back(*frame);
    }
    if (first.empty()) first = frames;
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_EQ(frames[i].range_m, first[i].range_m) << threads << " threads, frame " << i;
      EXPECT_EQ(frames[i].amplitude, first[i].amplitude);
    }
  }
}

TEST(Twin, GivesTheSameColourForAnyNumberOfThreads) {
  std::vector<ColorFrame> first;
  for (const int threads : {1, 2, 3}) {
    const sim::TemporaryFile room("room.xml", sim::Room(kRoomWithWall));
    TwinOptions options = WithColor(Options(room));
    if (!options.color) GTEST_SKIP() << "no GL";
    options.threads = threads;
    options.color->motion_blur = true;
    Twin twin(options);
    Robot robot = twin.robot();
    std::vector<ColorFrame> frames;
    robot.drive->Send({.speed_m_s = 0.5, .steering_rad = 0.2, .valid_for = std::chrono::seconds(10)});
    while (frames.size() < 8) {
      ASSERT_TRUE(robot.clock->WaitUntil(robot.clock->Now() + std::chrono::milliseconds(50)));
      while (auto frame = robot.color->Poll()) frames.push_back(*frame);
    }
    if (first.empty()) first = frames;
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_EQ(frames[i].bgr, first[i].bgr) << threads << " threads, frame " << i;
      EXPECT_EQ(frames[i].settings, first[i].settings);
    }
  }
}

TEST(Twin, HasNoPanUnitAndNoTurntableUnlessAskedFor) {
  const sim::TemporaryFile room("room.xml", sim::Room(kRoomWithWall));
  TwinOptions options = Options(room);
  options.world.car.pan->moves = false;
  EXPECT_EQ(Twin(options).robot().pan, nullptr);
  EXPECT_EQ(Twin(options).robot().turntable, nullptr);
}

TEST(Twin, ReportsTheLensItSeesThrough) {
  const sim::TemporaryFile room("room.xml", sim::Room(kRoomWithWall));
  const TwinOptions options = WithColor(Options(room));
  if (!options.color) GTEST_SKIP() << "no GL";
  Twin twin(options);
  EXPECT_EQ(twin.robot().color->Info().sheet.camera.k1, 0.024);
  EXPECT_EQ(twin.robot().color->Info().sheet.camera.p2, 0.0109);
}

TEST(Twin, SwitchingTheCompassOffChangesNoDepth) {
  const auto first_frame = [](bool compass) {
    const sim::TemporaryFile room("room.xml", sim::Room(kRoomWithWall));
    TwinOptions options = Options(room);
    if (!compass) options.compass.reset();
    Twin twin(options);
    Robot robot = twin.robot();
    EXPECT_TRUE(robot.clock->WaitUntil(std::chrono::milliseconds(100)));
    return robot.depth->Poll()->range_m;
  };
  EXPECT_EQ(first_frame(true), first_frame(false));
}

TEST(Twin, EndsWhenItsTimeIsOver) {
  const sim::TemporaryFile room("room.xml", sim::Room(kRoomWithWall));
  TwinOptions options = Options(room);
  options.end = std::chrono::milliseconds(100);
  Twin twin(options);
  EXPECT_TRUE(twin.robot().clock->WaitUntil(std::chrono::milliseconds(100)));
  EXPECT_FALSE(twin.robot().clock->WaitUntil(std::chrono::milliseconds(102)));
}

}  // namespace
}  // namespace merlin
