// Both ends of the microcontroller's line, in front of the simplest car.
#include "tests/robot/emulated/microcontroller_line.h"

#include <gtest/gtest.h>

#include <limits>

#include "robot/emulated/radio.h"
#include "tests/robot/emulated/toy_car.h"

namespace merlin {
namespace {

using std::chrono::milliseconds;
using Health = DeviceStatus::Health;
using ControllerLine = MicrocontrollerLine<ToyCar>;
constexpr int kBaud = ControllerLine::kBaud;

const DriveCommand kGo{.speed_m_s = 0.5, .steering_rad = 0.1, .valid_for = milliseconds(300)};

// Drives, then the fault begins while the stack goes on commanding (or not): braked 200 ms later?
void ExpectBraked(ControllerLine& line, const LineFault& fault, std::optional<DriveCommand> command) {
  line.Run(milliseconds(1000), kGo);
  ASSERT_FALSE(line.car.braked());
  line.fault = fault;
  const Time begin = line.now;
  line.Run(milliseconds(1000), command);
  EXPECT_LE(line.last_driven - begin, milliseconds(200));
}

TEST(MicrocontrollerLine, DrivesAndReports) {
  ControllerLine line;
  line.Run(milliseconds(2000), kGo);
  EXPECT_EQ(line.host.status().health, Health::kOk);
  EXPECT_EQ(line.host.status().garbage, 0u);
  EXPECT_EQ(line.host.firmware(), "merlin emulator 1");
  EXPECT_EQ(line.host.Complaint(), "");
  EXPECT_NEAR(static_cast<double>(line.states.size()), 100.0, 2.0);
  const DriveState& last = line.states.back();
  EXPECT_NEAR(static_cast<double>(last.encoder_counts), 0.5 * Seconds(last.stamp) * ToyCar::kCountsPerMetre, 10.0);
  EXPECT_NEAR(last.steering_rad, 0.1, 1e-9);
  EXPECT_NEAR(last.current_a, 1.5, 1e-9);
  EXPECT_NEAR(last.battery_v, 12.0, 1e-9);
  EXPECT_FALSE(last.expired);
}

// Sampled on the emulator's 20 ms grid: the host cannot see that, but must find it from the bytes' times.
TEST(MicrocontrollerLine, StampsTheSamplingInstant) {
  ControllerLine line;
  line.Run(milliseconds(2000), kGo);
  for (std::size_t i = 0; i < line.states.size(); ++i) {
    const double error_s = Seconds(line.states[i].stamp - milliseconds(20) * static_cast<int>(i));
    EXPECT_NEAR(error_s, 0.0, 0.0025) << i;  // the host looks once a millisecond; the micro's own clock counts them
  }
  for (std::size_t i = 1; i < line.states.size(); ++i) EXPECT_GT(line.states[i].stamp, line.states[i - 1].stamp);
}

TEST(MicrocontrollerLine, GoesOnCountingAcrossTheWrapOf32Bits) {
  ControllerLine line;
  line.car.counts_at_start = 0x7FFFFFFF - 100;
  line.Run(milliseconds(2000), kGo);
  EXPECT_GT(line.states.back().encoder_counts, std::int64_t{0x7FFFFFFF} + 500);
  for (std::size_t i = 1; i < line.states.size(); ++i)
    EXPECT_LE(line.states[i].encoder_counts - line.states[i - 1].encoder_counts, 11);
}

TEST(MicrocontrollerLine, BrakesWhenTheCommandExpiresAndNotBefore) {
  ControllerLine line;
  line.Run(milliseconds(1000), kGo);
  const Time last_sent = line.now - milliseconds(50);
  line.Run(milliseconds(1000));
  EXPECT_NEAR(Seconds(line.last_driven - last_sent), 0.3, 0.01);
  EXPECT_TRUE(line.states.back().expired);
}

TEST(MicrocontrollerLine, KeepsALongCommandGoingWithoutTheStack) {
  ControllerLine line;
  DriveCommand longer = kGo;
  longer.valid_for = Duration::max();
  line.host.Command(longer, line.now);
  line.Run(milliseconds(3000));
  EXPECT_FALSE(line.car.braked());
}

TEST(MicrocontrollerLine, BrakesForNumbersThatAreNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    ControllerLine speed, steering;
    ExpectBraked(speed, {}, DriveCommand{bad, 0.0, std::chrono::seconds(10)});
    ExpectBraked(steering, {}, DriveCommand{0.5, -bad, std::chrono::seconds(10)});
  }
}

TEST(MicrocontrollerLine, BrakesForCommandsThatHaveExpiredWhenTheyCome) {
  for (const Duration stale : {Duration(0), Duration(-1), Duration::min()}) {
    ControllerLine line;
    ExpectBraked(line, {}, DriveCommand{0.5, 0.0, stale});
    EXPECT_TRUE(line.states.back().expired);
  }
}

TEST(MicrocontrollerLine, BrakesWhenNothingArrives) {
  ControllerLine line;
  ExpectBraked(line, Silence(), kGo);
  EXPECT_EQ(line.host.status().health, Health::kSilent);
  EXPECT_EQ(line.host.Complaint(), "microcontroller on line: it is silent");
}

TEST(MicrocontrollerLine, BrakesWhenOnlyGarbageArrives) {
  ControllerLine line;
  ExpectBraked(line, Garbage(), kGo);
  EXPECT_EQ(line.host.status().health, Health::kFaulty);
  EXPECT_GT(line.host.status().garbage, 100u);
  EXPECT_NE(line.host.Complaint().find("nothing it sends can be read; is it set to 57600 baud?"), std::string::npos);
}

TEST(MicrocontrollerLine, BrakesWhenOnlyHalvesOfFramesArrive) {
  ControllerLine line;
  ExpectBraked(line, Halves(), kGo);
}

TEST(MicrocontrollerLine, BrakesWhenOnlyDuplicatesOfACommandArrive) {
  ControllerLine line;
  ExpectBraked(line, Duplicates(), DriveCommand{0.5, 0.0, milliseconds(150)});
}

TEST(MicrocontrollerLine, BrakesWhenCommandsComeLate) {
  ControllerLine line;
  ExpectBraked(line, Late(milliseconds(400)), kGo);  // longer than they hold
}

TEST(MicrocontrollerLine, IsNotDisturbedByDuplicatesBetweenGoodFrames) {
  ControllerLine line;
  line.fault = [](Time, Side, Bytes sent) {
    const Bytes once = sent;
    sent.insert(sent.end(), once.begin(), once.end());
    return sent;
  };
  line.Run(milliseconds(2000), kGo);
  EXPECT_FALSE(line.car.braked());
  for (std::size_t i = 1; i < line.states.size(); ++i) EXPECT_GT(line.states[i].stamp, line.states[i - 1].stamp);
  EXPECT_NEAR(static_cast<double>(line.states.size()), 100.0, 2.0);
}

TEST(MicrocontrollerLine, SurvivesAFloodOfCommands) {
  ControllerLine line;
  for (int i = 0; i < 1000; ++i) {
    for (int k = 0; k < 100; ++k) line.host.Command(kGo, line.now);
    line.Run(ControllerLine::kTick);
  }
  EXPECT_FALSE(line.car.braked());
  line.host.Command({}, line.now);
  const Time begin = line.now;
  line.Run(milliseconds(500));
  EXPECT_LE(line.last_driven - begin, milliseconds(20));  // no queue of old ones before it
}

TEST(MicrocontrollerLine, LetsTheNewestOfAFloodExpire) {
  ControllerLine line;
  line.Run(milliseconds(1000), kGo);
  for (int k = 0; k < 5000; ++k) line.host.Command({0.5, 0.1, std::chrono::hours(1)}, line.now);
  line.host.Command(kGo, line.now);
  const Time begin = line.now;
  line.Run(milliseconds(1000));
  EXPECT_NEAR(Seconds(line.last_driven - begin), 0.3, 0.01);
}

// A byte a millisecond: a frame all the same.
TEST(MicrocontrollerLine, JoinsWhatComesInPieces) {
  ControllerLine line;
  std::deque<std::uint8_t> held;
  line.fault = [&held](Time, Side from, const Bytes& sent) {
    if (from == Side::kDevice) return sent;
    held.insert(held.end(), sent.begin(), sent.end());
    if (held.empty()) return Bytes();
    const Bytes one{held.front()};
    held.pop_front();
    return one;
  };
  line.Run(milliseconds(2000), kGo);
  EXPECT_FALSE(line.car.braked());
  EXPECT_EQ(line.micro->counters().garbage_bytes, 0u);
  EXPECT_GT(line.states.back().encoder_counts, 900);
}

TEST(MicrocontrollerLine, BrakesWhenThePortGoesAndDrivesAgainWhenItComesBack) {
  ControllerLine line;
  line.Run(milliseconds(1000), kGo);
  line.host.Disconnected(line.now);
  EXPECT_EQ(line.host.status().health, Health::kAbsent);
  EXPECT_EQ(line.host.status().since, line.now);
  line.fault = Silence();
  const Time begin = line.now;
  line.Run(milliseconds(1000), kGo);
  EXPECT_LE(line.last_driven - begin, milliseconds(200));
  line.fault = {};
  line.host.Connected(line.now);
  line.Run(milliseconds(500), kGo);
  EXPECT_FALSE(line.car.braked());
  EXPECT_EQ(line.host.status().health, Health::kOk);
}

// A new program whose clock begins at 0, behind a microcontroller that has long heard another.
TEST(MicrocontrollerLine, TakesCommandsOfARestartedHost) {
  ControllerLine line;
  line.now = std::chrono::hours(1);
  line.Run(milliseconds(1000), kGo);
  line.host_started = line.now;
  line.host = MicrocontrollerHost(MicrocontrollerConfig{.serial = {.port = "line", .baud = kBaud}});
  line.host.Connected(Time(0));
  line.Run(milliseconds(500), kGo);
  EXPECT_FALSE(line.car.braked());
  EXPECT_EQ(line.host.status().health, Health::kOk);
  EXPECT_LT(line.states.back().stamp, milliseconds(500));
}

TEST(MicrocontrollerLine, ContinuesAfterTheMicrocontrollerRestarts) {
  ControllerLine line;
  line.Run(milliseconds(2000), kGo);
  const std::int64_t counts = line.states.back().encoder_counts;
  line.SwitchOn();
  line.Run(milliseconds(1000), kGo);
  EXPECT_FALSE(line.car.braked());
  EXPECT_GE(line.states.back().encoder_counts, counts);
  for (std::size_t i = 1; i < line.states.size(); ++i) EXPECT_GT(line.states[i].stamp, line.states[i - 1].stamp);
}

TEST(MicrocontrollerLine, StaysBrakedBeforeTheFirstCommand) {
  ControllerLine line;
  line.Run(milliseconds(1000));
  EXPECT_TRUE(line.car.braked());
  EXPECT_TRUE(line.states.back().expired);
  EXPECT_EQ(line.host.status().health, Health::kOk);
}

TEST(MicrocontrollerLine, TurnsThePanUnitAndReportsIt) {
  ControllerLine line;
  line.host.Pan(std::numeric_limits<double>::quiet_NaN());  // ignored
  line.host.Pan(1.2);
  line.Run(milliseconds(100));
  EXPECT_NEAR(line.car.pan_rad, 1.2, 1e-9);
  EXPECT_TRUE(line.host.has_pan());
  std::optional<PanState> last;
  while (const auto state = line.host.pan_states.Take()) last = state;
  ASSERT_TRUE(last);
  EXPECT_NEAR(last->angle_rad, 1.2, 1e-9);
}

TEST(MicrocontrollerLine, SaysWhichVersionIsWrong) {
  ControllerLine line;
  line.fault = [](Time, Side from, const Bytes& sent) {
    if (from == Side::kHost) return sent;
    return Bytes{0x00, 0x03, 0x02, 0x81, 0x04, 0x02, 0x45, 0x80, 0x00};  // a Hello reply of version 2, CRC by hand
  };
  line.Run(milliseconds(300));
  EXPECT_EQ(line.host.Complaint(), "microcontroller on line: it speaks version 2 of the protocol; expected 1");
}

TEST(MicrocontrollerEmulator, WarnsOfABatteryBelowItsLimit) {
  ToyCar car;
  MicrocontrollerEmulator micro({}, car.Wired(), Time(0));
  microcontroller::Decoder<microcontroller::ToHost> decoder;
  Time now{0};
  for (const auto& [battery_v, low] :
       std::vector<std::pair<double, bool>>{{12.0, false}, {10.8, false}, {10.7, true}}) {
    car.battery_v = battery_v;
    const auto received = decoder.Feed(micro.Send(now += milliseconds(20)));
    ASSERT_EQ(received.size(), 1u);
    EXPECT_EQ(std::get<microcontroller::State>(received[0].message).low_battery, low) << battery_v;
  }
}

// 20 states a second and a command every 50 ms share one channel: slow and lossy, but never unsafe.
TEST(MicrocontrollerLine, DrivesOverTheRadioAndBrakesWhenItIsLost) {
  ControllerLine line(std::make_unique<Radio>(RadioConfig{.baud = kBaud, .packet_loss = 0.05}, 1));
  line.Run(milliseconds(5000), kGo);
  EXPECT_GT(line.states.size(), 50u);
  EXPECT_GT(line.states.back().encoder_counts, 1500);  // of 2500 without any loss
  line.fault = Silence();
  const Time begin = line.now;
  line.Run(milliseconds(1000), kGo);
  EXPECT_LE(line.last_driven - begin, milliseconds(200));
}

}  // namespace
}  // namespace merlin
