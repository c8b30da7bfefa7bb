// The shipped drivers, with their threads, over pseudo-terminals against the emulated devices, in real time. The effect
// of each fault is tested without threads in tests/robot/emulated; these tests show that threads and ports work. A wait
// ends when its condition holds; it fails only after 20 s.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "robot/base/error.h"
#include "robot/emulated/compass_3dm_emulator.h"
#include "robot/emulated/serial_line.h"
#include "robot/emulated/serial_pump.h"
#include "robot/hardware/compass/compass_3dm_driver.h"
#include "robot/hardware/drive/microcontroller_drive.h"
#include "robot/hardware/real_clock.h"
#include "tests/robot/emulated/toy_car.h"

namespace merlin {
namespace {

using std::chrono::milliseconds;
using Health = DeviceStatus::Health;
constexpr int kBaud = 57600;
const DriveCommand kGo{.speed_m_s = 0.5, .steering_rad = 0.1, .valid_for = milliseconds(500)};

std::filesystem::path Link(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / ("merlin_" + name + "_" + std::to_string(getpid()));
}

// The devices of a toy car behind pseudo-terminals, kept going by a thread.
class Devices {
 public:
  explicit Devices(const Clock& clock) : clock_(clock), thread_([this] { Run(); }) {}
  ~Devices() {
    stop_ = true;
    thread_.join();
  }
  template <class Function>
  auto Locked(Function function) {
    const std::lock_guard lock(mutex_);
    return function();
  }
  bool braked() {
    return Locked([this] { return car.braked(); });
  }

  PseudoTerminal micro_port{Link("micro")}, compass_port{Link("compass")};
  ToyCar car;
  CompassReading body{.roll_rad = 0.1, .pitch_rad = -0.1, .yaw_rad = 2.0};

 private:
  void Run() {
    MicrocontrollerEmulator micro({}, car.Wired(), clock_.Now());
    Compass3dmEmulator compass({}, [this] { return body; });
    SerialPump micro_pump(micro_port, std::make_unique<SerialLine>(kBaud), micro, kBaud);
    SerialPump compass_pump(compass_port, std::make_unique<SerialLine>(9600), compass, 9600);
    while (!stop_) {
      Locked([&] {
        car.Step(clock_.Now());
        micro_pump.Step(clock_.Now());
        compass_pump.Step(clock_.Now());
      });
      std::this_thread::sleep_for(milliseconds(1));
    }
  }

  const Clock& clock_;
  std::mutex mutex_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

class Drivers : public ::testing::Test {
 protected:
  // Waits until the condition holds, while the stack ticks. False if it did not hold within 20 s.
  template <class Condition>
  bool Eventually(Condition condition, const std::optional<DriveCommand>& command = std::nullopt) {
    for (const Time end = clock.Now() + std::chrono::seconds(20); clock.Now() < end;) {
      if (command) drive->Send(*command);
      if (condition()) return true;
      clock.WaitUntil(clock.Now() + milliseconds(10));
    }
    return false;
  }
  bool DriveBecomes(Health health, const std::optional<DriveCommand>& command = std::nullopt) {
    return Eventually([&] { return drive->Status().health == health; }, command);
  }

  RealClock clock{{}, Time::max()};
  Devices devices{clock};
  std::unique_ptr<MicrocontrollerDrive> drive = std::make_unique<MicrocontrollerDrive>(
      MicrocontrollerConfig{.serial = {.port = devices.micro_port.path(), .baud = kBaud}}, clock);
};

TEST_F(Drivers, DriveTheCarAndStopItAtTheEnd) {
  ASSERT_TRUE(DriveBecomes(Health::kOk));
  EXPECT_TRUE(devices.braked());
  ASSERT_TRUE(Eventually([&] { return !devices.braked(); }, kGo));
  std::vector<DriveState> states;
  ASSERT_TRUE(Eventually(
      [&] {
        while (const auto state = drive->Poll()) states.push_back(*state);
        return states.size() >= 50 && states.back().encoder_counts > 100;
      },
      kGo));
  for (std::size_t i = 1; i < states.size(); ++i) EXPECT_GT(states[i].stamp, states[i - 1].stamp);
  EXPECT_LE(states.back().stamp, clock.Now());
  EXPECT_NEAR(states.back().steering_rad, 0.1, 1e-9);
  EXPECT_EQ(drive->firmware(), "merlin emulator 1");
  DriveCommand for_long = kGo;
  for_long.valid_for = std::chrono::hours(1);
  drive->Send(for_long);
  drive.reset();
  ASSERT_TRUE(Eventually([&] { return devices.braked(); }));
}

TEST_F(Drivers, ReadTheCompass) {
  Compass3dmDriver compass({.serial = {.port = devices.compass_port.path(), .baud = 9600}}, clock);
  std::vector<CompassReading> readings;
  ASSERT_TRUE(Eventually([&] {
    while (const auto reading = compass.Poll()) readings.push_back(*reading);
    return readings.size() >= 10;
  }));
  EXPECT_EQ(compass.Status().health, Health::kOk);
  EXPECT_EQ(compass.Status().delivered, readings.size());
  for (std::size_t i = 1; i < readings.size(); ++i) EXPECT_GT(readings[i].stamp, readings[i - 1].stamp);
  EXPECT_NEAR(readings.back().yaw_rad, 2.0, 1e-4);
  EXPECT_NEAR(readings.back().roll_rad, 0.1, 1e-4);
  EXPECT_NEAR(readings.back().pitch_rad, -0.1, 1e-4);
}

TEST_F(Drivers, LosePortAndFindItAgainWithTheCarBrakedMeanwhile) {
  ASSERT_TRUE(Eventually([&] { return !devices.braked(); }, kGo));
  devices.Locked([&] { devices.micro_port.Close(); });
  ASSERT_TRUE(DriveBecomes(Health::kAbsent, kGo));
  EXPECT_NE(drive->Complaint().find("the port has gone"), std::string::npos);
  ASSERT_TRUE(Eventually([&] { return devices.braked(); }, kGo));
  devices.Locked([&] { devices.micro_port.Open(); });
  ASSERT_TRUE(DriveBecomes(Health::kOk, kGo));
  ASSERT_TRUE(Eventually([&] { return !devices.braked(); }, kGo));
}

TEST_F(Drivers, TellAWrongBaudRate) {
  drive.reset();
  drive = std::make_unique<MicrocontrollerDrive>(
      MicrocontrollerConfig{.serial = {.port = devices.micro_port.path(), .baud = 19200}}, clock);
  ASSERT_TRUE(DriveBecomes(Health::kFaulty, kGo));
  EXPECT_NE(drive->Complaint().find("is it set to 19200 baud?"), std::string::npos);
  EXPECT_GT(drive->Status().garbage, 0u);
  EXPECT_TRUE(devices.braked());
}

TEST_F(Drivers, RefuseAPortThatIsInUseOrMissing) {
  EXPECT_THROW(MicrocontrollerDrive({.serial = {.port = devices.micro_port.path(), .baud = kBaud}}, clock),
               MachineError);
  EXPECT_THROW(Compass3dmDriver({.serial = {.port = "/dev/no_such_port", .baud = 9600}}, clock), MachineError);
}

TEST_F(Drivers, BrakeWhenTheStackStalls) {
  std::atomic<int> stalls = 0;
  RealClock ticking({.watchdog_s = 0.1}, Time::max());
  ticking.OnStall([&] {
    ++stalls;
    drive->Send({});
  });
  DriveCommand for_long = kGo;
  for_long.valid_for = std::chrono::hours(1);
  ASSERT_TRUE(Eventually([&] { return !devices.braked(); }, for_long));
  EXPECT_EQ(stalls, 0);  // it has not ticked yet
  ASSERT_TRUE(ticking.WaitUntil(ticking.Now() + milliseconds(1)));
  ASSERT_TRUE(Eventually([&] { return devices.braked(); }));  // the stack does not come back
  EXPECT_EQ(stalls, 1);
  ticking.OnStall({});
}

TEST(RealClock, WaitsForTheTimeAndNotForThePast) {
  RealClock clock({}, Time::max());
  const Time before = clock.Now();
  EXPECT_TRUE(clock.WaitUntil(before - milliseconds(5)));
  EXPECT_TRUE(clock.WaitUntil(before + milliseconds(20)));
  EXPECT_GE(clock.Now(), before + milliseconds(20));
}

TEST(RealClock, SaysWhenTheRunIsOver) {
  RealClock clock({}, milliseconds(20));
  EXPECT_FALSE(clock.WaitUntil(std::chrono::hours(1)));
  EXPECT_GE(clock.Now(), milliseconds(20));
  RealClock ended({}, Time::max());
  std::thread other([&] { ended.End(); });
  EXPECT_FALSE(ended.WaitUntil(std::chrono::hours(1)));
  other.join();
}

}  // namespace
}  // namespace merlin
