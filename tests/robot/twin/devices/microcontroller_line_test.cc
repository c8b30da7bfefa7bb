// Both ends of the microcontroller's line, host (the shipped driver without its thread) and emulator, joined by a cable
// with its timing and by faults. Time and bytes are injected: nothing sleeps.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "robot/hardware/microcontroller_host.h"
#include "robot/twin/devices/radio.h"
#include "robot/twin/devices/serial_line.h"
#include "tests/robot/twin/devices/toy_car.h"

namespace merlin {
namespace {

using std::chrono::milliseconds;
using Health = DeviceStatus::Health;
constexpr Duration kTick = milliseconds(1);
constexpr int kBaud = 57600;

const DriveCommand kGo{.speed_m_s = 0.5, .steering_rad = 0.1, .valid_for = milliseconds(300)};

// What a fault makes of the bytes that an end has just sent.
using Fault = std::function<Bytes(Time now, Side from, const Bytes& sent)>;

class Line {
 public:
  explicit Line(std::unique_ptr<Channel> channel = std::make_unique<SerialLine>(kBaud), Time start = Time(0))
      : now(start), channel_(std::move(channel)) {
    car.Step(now);
    SwitchOn();
    host.Connected(now);
  }

  // The stack renews the command every 50 ms, if it has one.
  void Run(Duration duration, const std::optional<DriveCommand>& command = std::nullopt) {
    for (const Time end = now + duration; now < end; now += kTick) {
      car.Step(now);
      if (command && now % milliseconds(50) == Duration(0)) host.Command(*command, now - host_started);
      host.Receive(now - host_started, channel_->Take(Side::kHost, now));
      Put(Side::kHost, host.Send(now - host_started));
      micro->Receive(now, channel_->Take(Side::kDevice, now));
      Put(Side::kDevice, micro->Send(now));
      while (const auto state = host.states.Take()) states.push_back(*state);
      if (!car.braked()) last_driven = now;
    }
  }
  void SwitchOn() {
    micro = std::make_unique<MicrocontrollerEmulator>(MicrocontrollerEmulatorConfig{}, car.Wired(), now);
  }

  Time now, last_driven{0}, host_started{0};
  ToyCar car;
  MicrocontrollerHost host{MicrocontrollerConfig{.serial = {.port = "line", .baud = kBaud}}};
  std::unique_ptr<MicrocontrollerEmulator> micro;
  std::vector<DriveState> states;
  Fault fault;

 private:
  void Put(Side from, const Bytes& sent) { channel_->Put(from, now, fault ? fault(now, from, sent) : sent); }
  std::unique_ptr<Channel> channel_;
};

// Drives, then the fault begins while the stack goes on commanding (or not): braked 200 ms later?
void ExpectBraked(Line& line, const Fault& fault, std::optional<DriveCommand> command) {
  line.Run(milliseconds(1000), kGo);
  ASSERT_FALSE(line.car.braked());
  line.fault = fault;
  const Time begin = line.now;
  line.Run(milliseconds(1000), command);
  EXPECT_LE(line.last_driven - begin, milliseconds(200));
}

TEST(MicrocontrollerLine, DrivesAndReports) {
  Line line;
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
  EXPECT_NEAR(last.battery_v, 7.2, 1e-9);
  EXPECT_FALSE(last.expired);
}

// Sampled on the emulator's 20 ms grid: the host cannot see that, but must find it from the bytes' times.
TEST(MicrocontrollerLine, StampsTheSamplingInstant) {
  Line line;
  line.Run(milliseconds(2000), kGo);
  for (std::size_t i = 0; i < line.states.size(); ++i) {
    const double error_s = Seconds(line.states[i].stamp - milliseconds(20) * static_cast<int>(i));
    EXPECT_NEAR(error_s, 0.0, 0.0025) << i;  // the host looks once a millisecond; the micro's own clock counts them
  }
  for (std::size_t i = 1; i < line.states.size(); ++i) EXPECT_GT(line.states[i].stamp, line.states[i - 1].stamp);
}

TEST(MicrocontrollerLine, GoesOnCountingAcrossTheWrapOf32Bits) {
  Line line;
  line.car.counts_at_start = 0x7FFFFFFF - 100;
  line.Run(milliseconds(2000), kGo);
  EXPECT_GT(line.states.back().encoder_counts, std::int64_t{0x7FFFFFFF} + 500);
  for (std::size_t i = 1; i < line.states.size(); ++i)
    EXPECT_LE(line.states[i].encoder_counts - line.states[i - 1].encoder_counts, 11);
}

TEST(MicrocontrollerLine, BrakesWhenTheCommandExpiresAndNotBefore) {
  Line line;
  line.Run(milliseconds(1000), kGo);
  const Time last_sent = line.now - milliseconds(50);
  line.Run(milliseconds(1000));
  EXPECT_NEAR(Seconds(line.last_driven - last_sent), 0.3, 0.01);
  EXPECT_TRUE(line.states.back().expired);
}

TEST(MicrocontrollerLine, KeepsALongCommandGoingWithoutTheStack) {
  Line line;
  DriveCommand longer = kGo;
  longer.valid_for = Duration::max();
  line.host.Command(longer, line.now);
  line.Run(milliseconds(3000));
  EXPECT_FALSE(line.car.braked());
}

TEST(MicrocontrollerLine, BrakesForNumbersThatAreNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Line speed, steering;
    ExpectBraked(speed, {}, DriveCommand{bad, 0.0, std::chrono::seconds(10)});
    ExpectBraked(steering, {}, DriveCommand{0.5, -bad, std::chrono::seconds(10)});
  }
}

TEST(MicrocontrollerLine, BrakesWhenNothingArrives) {
  Line line;
  ExpectBraked(
      line, [](Time, Side, const Bytes&) { return Bytes(); }, kGo);
  EXPECT_EQ(line.host.status().health, Health::kSilent);
  EXPECT_EQ(line.host.Complaint(), "microcontroller on line: it is silent");
}

TEST(MicrocontrollerLine, BrakesWhenOnlyGarbageArrives) {
  std::mt19937 random(1);
  Line line;
  ExpectBraked(
      line,
      [&](Time, Side, Bytes sent) {
        for (std::uint8_t& byte : sent) byte = static_cast<std::uint8_t>(random());
        return sent;
      },
      kGo);
  EXPECT_EQ(line.host.status().health, Health::kFaulty);
  EXPECT_GT(line.host.status().garbage, 100u);
  EXPECT_NE(line.host.Complaint().find("nothing it sends can be read; is it set to 57600 baud?"), std::string::npos);
}

TEST(MicrocontrollerLine, BrakesWhenOnlyHalvesOfFramesArrive) {
  Line line;
  ExpectBraked(
      line, [](Time, Side, const Bytes& sent) { return Bytes(sent.begin(), sent.begin() + sent.size() / 2); }, kGo);
}

// The last command again and again, as a stuck buffer would.
TEST(MicrocontrollerLine, BrakesWhenOnlyDuplicatesOfACommandArrive) {
  Line line;
  Bytes last;
  Time repeat{0};
  ExpectBraked(
      line,
      [&](Time now, Side from, const Bytes& sent) {
        if (from == Side::kDevice) return sent;
        if (last.empty()) last = sent;
        if (last.empty() || now < repeat) return Bytes();
        repeat = now + milliseconds(20);
        return last;
      },
      DriveCommand{0.5, 0.0, milliseconds(150)});
}

TEST(MicrocontrollerLine, BrakesWhenCommandsComeLate) {
  Line line;
  std::deque<std::pair<Time, Bytes>> held;
  ExpectBraked(
      line,
      [&](Time now, Side from, const Bytes& sent) {
        if (from == Side::kDevice) return sent;
        held.emplace_back(now + milliseconds(400), sent);  // longer than they hold
        Bytes due;
        while (!held.empty() && held.front().first <= now) {
          due.insert(due.end(), held.front().second.begin(), held.front().second.end());
          held.pop_front();
        }
        return due;
      },
      kGo);
}

TEST(MicrocontrollerLine, IsNotDisturbedByDuplicatesBetweenGoodFrames) {
  Line line;
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
  Line line;
  for (int i = 0; i < 1000; ++i) {
    for (int k = 0; k < 100; ++k) line.host.Command(kGo, line.now);
    line.Run(kTick);
  }
  EXPECT_FALSE(line.car.braked());
  line.host.Command({}, line.now);
  const Time begin = line.now;
  line.Run(milliseconds(500));
  EXPECT_LE(line.last_driven - begin, milliseconds(20));  // no queue of old ones before it
}

TEST(MicrocontrollerLine, BrakesWhenThePortGoesAndDrivesAgainWhenItComesBack) {
  Line line;
  line.Run(milliseconds(1000), kGo);
  line.host.Disconnected(line.now);
  EXPECT_EQ(line.host.status().health, Health::kAbsent);
  EXPECT_EQ(line.host.status().since, line.now);
  line.fault = [](Time, Side, const Bytes&) { return Bytes(); };
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
TEST(MicrocontrollerLine, TakesCommandsOfAHostThatStartedAnew) {
  Line line;
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

TEST(MicrocontrollerLine, GoesOnWhenTheMicrocontrollerStartsAnew) {
  Line line;
  line.Run(milliseconds(2000), kGo);
  const std::int64_t counts = line.states.back().encoder_counts;
  line.SwitchOn();
  line.Run(milliseconds(1000), kGo);
  EXPECT_FALSE(line.car.braked());
  EXPECT_GE(line.states.back().encoder_counts, counts);
  for (std::size_t i = 1; i < line.states.size(); ++i) EXPECT_GT(line.states[i].stamp, line.states[i - 1].stamp);
}

TEST(MicrocontrollerLine, StaysBrakedBeforeTheFirstCommand) {
  Line line;
  line.Run(milliseconds(1000));
  EXPECT_TRUE(line.car.braked());
  EXPECT_TRUE(line.states.back().expired);
  EXPECT_EQ(line.host.status().health, Health::kOk);
}

TEST(MicrocontrollerLine, TurnsThePanUnitAndReportsIt) {
  Line line;
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
  Line line;
  line.fault = [](Time, Side from, const Bytes& sent) {
    if (from == Side::kHost) return sent;
    return Bytes{0x00, 0x03, 0x02, 0x81, 0x04, 0x02, 0x45, 0x80, 0x00};  // a Hello reply of version 2, CRC by hand
  };
  line.Run(milliseconds(300));
  EXPECT_EQ(line.host.Complaint(), "microcontroller on line: it speaks version 2 of the protocol; expected 1");
}

// 20 states a second and a command every 50 ms share one channel: slow and lossy, but never unsafe.
TEST(MicrocontrollerLine, DrivesOverTheRadioAndBrakesWhenItIsLost) {
  Line line(std::make_unique<Radio>(RadioConfig{.baud = kBaud, .packet_loss = 0.05}, 1));
  line.Run(milliseconds(5000), kGo);
  EXPECT_GT(line.states.size(), 50u);
  EXPECT_GT(line.states.back().encoder_counts, 1500);  // of 2500 without any loss
  line.fault = [](Time, Side, const Bytes&) { return Bytes(); };
  const Time begin = line.now;
  line.Run(milliseconds(1000), kGo);
  EXPECT_LE(line.last_driven - begin, milliseconds(200));
}

}  // namespace
}  // namespace merlin
