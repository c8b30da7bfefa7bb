// The 3DM's two ends, joined by a cable at 9600 baud. Time and bytes are injected.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "robot/emulated/compass_3dm_emulator.h"
#include "robot/emulated/serial_line.h"
#include "robot/hardware/compass/compass_3dm_host.h"

namespace merlin {
namespace {

using std::chrono::milliseconds;
using Health = DeviceStatus::Health;
constexpr double kCount_rad = 2.0 * std::numbers::pi / 65536.0;

class CompassLine {
 public:
  explicit CompassLine(double north_yaw_rad = 0.0, bool with_checksum = false)
      : device({.north_yaw_rad = north_yaw_rad, .with_checksum = with_checksum},
               [this] {
                 sampled.push_back(now);
                 return body;
               }),
        host({.serial = {.port = "line", .baud = 9600},
              .poll = {.with_checksum = with_checksum},
              .north_yaw_rad = north_yaw_rad}) {
    host.Connected(now);
  }
  void Run(Duration duration) {
    for (const Time end = now + duration; now < end; now += milliseconds(1)) {
      const Bytes received = line_.Take(Side::kHost, now);
      host.Receive(now, fault ? fault(received) : received);
      line_.Put(Side::kHost, now, host.Send(now));
      device.Receive(now, line_.Take(Side::kDevice, now));
      line_.Put(Side::kDevice, now, device.Send(now));
      while (const auto reading = host.readings.Take()) readings.push_back(*reading);
    }
  }

  Time now{0};
  CompassReading body;
  Compass3dmEmulator device;
  Compass3dmHost host;
  std::vector<CompassReading> readings;
  std::vector<Time> sampled;
  std::function<Bytes(const Bytes&)> fault;

 private:
  SerialLine line_{9600};
};

TEST(Compass3dmLine, GivesTheBodysAnglesBackInEveryQuadrant) {
  for (const double north_rad : {0.0, 1.0, -2.5})
    for (const double yaw_rad : {-3.1, -2.0, -0.7, 0.0, 1e-3, 0.7, 2.0, 3.1}) {
      CompassLine line(north_rad);
      line.body = {.roll_rad = 0.2, .pitch_rad = -0.3, .yaw_rad = yaw_rad};
      line.Run(milliseconds(200));
      ASSERT_FALSE(line.readings.empty());
      EXPECT_NEAR(line.readings[0].roll_rad, 0.2, kCount_rad);
      EXPECT_NEAR(line.readings[0].pitch_rad, -0.3, kCount_rad);
      EXPECT_NEAR(line.readings[0].yaw_rad, yaw_rad, kCount_rad);
    }
}

TEST(Compass3dmLine, ReadsTwelveTimesASecondAndStampsTheSamplingInstant) {
  CompassLine line;
  line.Run(std::chrono::seconds(10));
  EXPECT_NEAR(static_cast<double>(line.readings.size()), 125.0, 2.0);
  for (std::size_t i = 1; i < line.readings.size(); ++i) EXPECT_GT(line.readings[i].stamp, line.readings[i - 1].stamp);
  for (std::size_t i = 0; i < line.readings.size(); ++i)
    EXPECT_NEAR(Seconds(line.readings[i].stamp - line.sampled[i]), 0.0, 0.0021);  // both ends look once a millisecond
  EXPECT_EQ(line.host.status().health, Health::kOk);
  EXPECT_EQ(line.host.Complaint(), "");
}

TEST(Compass3dmLine, WorksWithTheChecksum) {
  CompassLine line(0.0, true);
  line.Run(milliseconds(500));
  EXPECT_GE(line.readings.size(), 4u);
}

TEST(Compass3dmLine, TellsSilenceGarbageAndAMissingPort) {
  CompassLine line;
  line.Run(milliseconds(500));
  const std::size_t good = line.readings.size();
  line.fault = [](const Bytes&) { return Bytes(); };
  line.Run(milliseconds(1000));
  EXPECT_EQ(line.host.status().health, Health::kSilent);
  EXPECT_EQ(line.host.Complaint(), "3DM on line: it does not answer");
  line.fault = [](Bytes bytes) {
    for (std::uint8_t& byte : bytes) byte ^= 0x5A;
    return bytes;
  };
  line.Run(milliseconds(1000));
  EXPECT_EQ(line.host.status().health, Health::kFaulty);
  EXPECT_GT(line.host.status().garbage, 0u);
  EXPECT_EQ(line.readings.size(), good);  // never a wrong reading
  line.fault = {};
  line.Run(milliseconds(200));
  EXPECT_EQ(line.host.status().health, Health::kOk);
  line.host.Disconnected(line.now);
  EXPECT_EQ(line.host.status().health, Health::kAbsent);
}

// Partial replies, repeated replies and replies one poll too late give no reading, or exactly the one asked for.
TEST(Compass3dmLine, NeverTakesAPartialADoubledOrALateReplyForAnother) {
  for (const int kind : {0, 1, 2}) {
    CompassLine line;
    Bytes held;
    Time due{0};
    int calls = 0;
    line.fault = [&](const Bytes& received) {
      if (received.empty() && (held.empty() || line.now < due)) return Bytes();
      if (kind == 0) return ++calls % 2 == 0 ? received : Bytes();  // holes
      if (kind == 1) {
        Bytes twice = received;
        twice.insert(twice.end(), received.begin(), received.end());
        return twice;
      }
      if (received.empty()) return std::exchange(held, {});
      if (held.empty()) due = line.now + milliseconds(80);
      held.insert(held.end(), received.begin(), received.end());
      return Bytes();
    };
    line.body.yaw_rad = 1.0;
    line.Run(milliseconds(1000));
    line.body.yaw_rad = -1.0;
    line.Run(milliseconds(1000));
    for (const CompassReading& reading : line.readings)
      EXPECT_TRUE(std::abs(reading.yaw_rad - 1.0) < kCount_rad || std::abs(reading.yaw_rad + 1.0) < kCount_rad) << kind;
    line.fault = {};
    line.Run(milliseconds(300));
    ASSERT_FALSE(line.readings.empty());
    EXPECT_NEAR(line.readings.back().yaw_rad, -1.0, kCount_rad);
    EXPECT_EQ(line.host.status().health, Health::kOk);
  }
}

TEST(Compass3dmEmulator, AnswersOnlyARequestInTheRightOrderAndTime) {
  Compass3dmEmulator device({}, [] { return CompassReading{}; });
  device.Receive(Time(0), Bytes{0xC0});  // not in poll mode
  EXPECT_EQ(device.next(), Time::max());
  device.Receive(Time(0), Bytes{0x74, 0xC0});  // without the wait
  EXPECT_EQ(device.next(), Time::max());
  device.Receive(milliseconds(35), Bytes{0xC0});
  EXPECT_EQ(device.next(), milliseconds(40));
  EXPECT_TRUE(device.Send(milliseconds(39)).empty());
  EXPECT_EQ(device.Send(milliseconds(40)), (Bytes{0x44, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace merlin
