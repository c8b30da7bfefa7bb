// The calibrated steering offset between the stack's wheel angle and the servo's command.
#include <gtest/gtest.h>

#include "scenarios/run/drive_loop.h"

namespace merlin {
namespace {

std::atomic<bool> never{false};

struct ShortClock final : Clock {
  Time Now() const override { return now; }
  bool WaitUntil(Time time) override { return (now = time) < std::chrono::milliseconds(300); }
  Time now{0};
};

struct DarkCamera final : DepthCamera {
  DarkCamera() { info.rate_hz = 20.0; }
  const DepthCameraInfo& Info() const override { return info; }
  void Configure(const DepthSettings&) override {}
  std::optional<DepthFrame> Poll() override { return std::nullopt; }
  DeviceStatus Status() const override { return {}; }
  DepthCameraInfo info;
};

struct RecordingDrive final : Drive {
  void Send(const DriveCommand& command) override { sent.push_back(command); }
  std::optional<DriveState> Poll() override { return std::nullopt; }
  DeviceStatus Status() const override { return {}; }
  std::vector<DriveCommand> sent;
};

TEST(SteeringOffset, IsSubtractedExactlyOnceBeforeTheServo) {
  CarDescription car;
  car.wheelbase_m = 0.33;
  car.steering_max_rad = 0.4;
  car.steering_offset_rad = 0.05;  // the wheels point further left than the servo reports
  ShortClock clock;
  DarkCamera depth;
  RecordingDrive drive;
  DriveLoop loop({.clock = &clock, .depth = &depth, .drive = &drive}, car, {}, {}, {}, {});
  // Backwards, where nothing looks.
  loop.Run(never, {},
           [](Time now) { return ManualCommand{.heard = now, .held = true, .speed_m_s = -0.3, .steering_rad = 0.2}; });
  ASSERT_GE(drive.sent.size(), 2u);
  EXPECT_EQ(drive.sent.front().speed_m_s, -0.3);
  EXPECT_DOUBLE_EQ(drive.sent.front().steering_rad, 0.15);
  EXPECT_EQ(drive.sent.back().speed_m_s, 0.0) << "the loop halts the car at its end";
  EXPECT_DOUBLE_EQ(drive.sent.back().steering_rad, -0.05) << "with its wheels straight";
}

}  // namespace
}  // namespace merlin
