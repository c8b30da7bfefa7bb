// The twin behind the real drivers against the conformance suite: the same promises over serial lines, a vendor's
// library and a stream, in real time.
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "robot/emulated/emulated_robot.h"
#include "robot/hardware/hardware_robot.h"
#include "tests/robot/hal/merlin_before_wall.h"
#include "tests/support/cable.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

// The simulation would not keep real time under the thread sanitizer with all errors and 20 frames a second.
TwinOptions RealTimeOptions(const sim::TemporaryFile& room) {
  TwinOptions options = MerlinIn(room);
#ifdef __SANITIZE_THREAD__
  options.depth.effects = sim::kIdealTof;
  options.depth.rate_hz = 5.0;
#endif
  return options;
}

HardwareConfig DevicesOf(const EmulatedRobot& emulated, const std::filesystem::path& drive_port) {
  HardwareConfig config;
  config.clock.watchdog_s = 10.0;  // a test may take its time between two waits
  config.drive.serial = {drive_port, EmulatedRobot::kDriveBaud};
  config.compass.emplace().serial = {*emulated.compass_port(), 9600};
  config.depth.pmd.library = PMD_LIBRARY;
  config.depth.pmd.source_argument = emulated.depth_socket();
  return config;
}

class RiggedEmulation final : public MerlinBeforeWall {
 public:
  RiggedEmulation()
      : options_(RealTimeOptions(room_)),
        clock_({.watchdog_s = 10.0}, Time::max()),
        emulated_(options_, sockets_.path(), clock_),
        drive_cable_(emulated_.drive_port(), EmulatedRobot::kDriveBaud, sockets_.path() / "drive") {
    emulated_.Start();
    hardware_ = std::make_unique<HardwareRobot>(
        DevicesOf(emulated_, drive_cable_.port()),
        HardwareCameras{.depth = {options_.depth.sheet, options_.world.car.T_base_depth, options_.depth.rate_hz},
                        .depth_settings = options_.depth.settings},
        clock_);
    const std::vector<std::string> complaints = hardware_->WaitUntilReady(std::chrono::seconds(20));
    if (!complaints.empty()) throw std::runtime_error(complaints.front());  // there is nothing to test
    const Robot robot = hardware_->robot();
    while (robot.drive->Poll() || robot.compass->Poll() || robot.depth->Poll()) continue;  // what came meanwhile
  }
  Robot robot() override { return hardware_->robot(); }
  Duration slack() override { return std::chrono::milliseconds(150); }
  bool Unplug() override {
    drive_cable_.Pull();
    return true;
  }
  void PlugIn() override { drive_cable_.PlugIn(); }

 private:
  TemporaryFolder sockets_;
  TwinOptions options_;
  RealClock clock_;
  EmulatedRobot emulated_;
  Cable drive_cable_;
  std::unique_ptr<HardwareRobot> hardware_;
};

INSTANTIATE_TEST_SUITE_P(Emulated, HalConformance,
                         ::testing::Values(Plug{"emulated", [] { return std::make_unique<RiggedEmulation>(); }}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace merlin
