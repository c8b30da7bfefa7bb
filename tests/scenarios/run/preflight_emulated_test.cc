// The pre-flight check on a car that is simulated behind the real drivers and protocols, in real time.
#include <gtest/gtest.h>

#include <filesystem>

#include "robot/description/description.h"
#include "robot/emulated/emulated_robot.h"
#include "robot/hardware/hardware_robot.h"
#include "scenarios/run/preflight.h"
#include "tests/sim/world/car_world.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

constexpr char kBoxes[] = R"(<geom name="floor" type="plane" size="20 20 1"/>
  <geom type="box" size="0.1 5 2" pos="4.1 0 2"/>)";

class EmulatedPreflight : public ::testing::Test {
 protected:
  EmulatedPreflight() : room_("room.xml", sim::Room(kBoxes)), clock_({.watchdog_s = 10.0}, Time::max()) {
    options_.world.room = room_.path();
    options_.world.car = sim::Merlin();
    options_.depth.sheet =
        ReadDepthCameraSheet(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/pmd_3k_s.yaml");
    options_.compass = TwinOptions::Compass{};
    options_.end = Time::max();
  }
  // Switches the car on and returns the faults of the check at rest; if there are none, those of the check in motion.
  std::vector<std::string> Check() {
    EmulatedRobot emulated(options_, sockets_.path(), clock_);
    emulated.Start();
    HardwareConfig config;
    config.drive.serial = {emulated.drive_port(), EmulatedRobot::kDriveBaud};
    config.compass.emplace().serial = {*emulated.compass_port(), 9600};
    config.depth.pmd.library = PMD_LIBRARY;
    config.depth.pmd.source_argument = emulated.depth_socket();
    const HardwareCameras cameras{
        .depth = {options_.depth.sheet, options_.world.car.T_base_depth, options_.depth.rate_hz},
        .depth_settings = options_.depth.settings};
    HardwareRobot hardware(config, cameras, clock_);
    for (const std::string& complaint : hardware.WaitUntilReady(std::chrono::seconds(20))) ADD_FAILURE() << complaint;
    std::vector<std::string> faults = PreflightAtRest(hardware.robot(), options_.world.car);
    if (faults.empty()) faults = PreflightMoving(hardware.robot(), options_.world.car, not_stopped_);
    T_world_base_ = emulated.With([](Twin& twin) { return twin.world().T_world_base(); });
    return faults;
  }

  sim::TemporaryFile room_;
  TemporaryFolder sockets_;
  RealClock clock_;
  TwinOptions options_;
  const std::atomic<bool> not_stopped_{false};
  Pose T_world_base_ = Pose::Identity();
};

TEST_F(EmulatedPreflight, FindsNothingWrongAndBringsTheCarBack) {
  EXPECT_EQ(Check(), std::vector<std::string>{});
  EXPECT_LT(T_world_base_.translation().head<2>().norm(), 0.1);
}

// An empty battery has 10 V (sim/drive/battery.h).
TEST_F(EmulatedPreflight, FindsAnEmptyBatteryBeforeTheCarMoves) {
  options_.world.drivetrain.battery = {.capacity_ah = 0.05, .charge = 0.0};
  const std::vector<std::string> faults = Check();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].starts_with("the drive reports a battery of ")) << faults[0];
  EXPECT_LT(T_world_base_.translation().head<2>().norm(), 0.01);
}

}  // namespace
}  // namespace merlin
