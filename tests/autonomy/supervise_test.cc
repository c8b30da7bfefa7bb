#include "autonomy/supervise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace merlin {
namespace {

using Health = DeviceStatus::Health;

constexpr Duration kTick = std::chrono::nanoseconds(1);

// A device that was last heard at the run's second 10.
constexpr Time kHeard = std::chrono::seconds(10);
SupervisedDevice Device(const char* name, bool needed, double rate_hz, Health health = Health::kOk) {
  return {.name = name,
          .needed = needed,
          .status = {.health = health, .since = kHeard, .rate_hz = rate_hz},
          .heard = kHeard};
}

// What supervision says about one device at a given time.
Supervisor After(const SupervisedDevice& device, Time now) {
  Supervisor supervisor;
  supervisor.Watch(now, std::span(&device, 1));
  return supervisor;
}

// 20 Hz and 7 Hz: three periods are shorter than 0.5 s (150 and 429 ms). 5 Hz: 600 ms. 2 Hz: 1500 ms.
TEST(Supervise, CountsADeviceAsSilentAfterHalfASecondOrThreePeriodsWhicheverIsLonger) {
  const std::pair<double, int> patience_ms[] = {{0.0, 500},   {1000.0, 500}, {50.0, 500},        {20.0, 500},
                                                {7.0, 500},   {6.0, 500},    {5.0, 600},         {2.0, 1500},
                                                {0.1, 30000}, {-1.0, 500},   {std::nan(""), 500}};
  for (const auto& [rate_hz, ms] : patience_ms) {
    const SupervisedDevice camera = Device("depth camera", true, rate_hz);
    const Time last = kHeard + std::chrono::milliseconds(ms);
    EXPECT_EQ(PatienceWith(camera.status), std::chrono::milliseconds(ms)) << rate_hz;
    EXPECT_EQ(HealthOf(camera, kHeard), Health::kOk) << rate_hz;
    EXPECT_EQ(HealthOf(camera, last), Health::kOk) << rate_hz;
    EXPECT_EQ(HealthOf(camera, last + kTick), Health::kSilent) << rate_hz;
  }
}

TEST(Supervise, StopsTheCarForADeviceItNeedsWhateverIsWrongWithIt) {
  for (const char* name : {"depth camera", "drive"})
    for (const auto& [health, word] : {std::pair(Health::kOk, "silent"), std::pair(Health::kSilent, "silent"),
                                       std::pair(Health::kFaulty, "unreadable"), std::pair(Health::kAbsent, "gone")}) {
      const SupervisedDevice device = Device(name, true, 20.0, health);
      EXPECT_EQ(After(device, kHeard + std::chrono::milliseconds(500)).stop(), "");
      const Supervisor after = After(device, kHeard + std::chrono::milliseconds(600));
      EXPECT_EQ(after.stop(), std::string("the ") + name + " has been " + word + " for 0.6 s");
      EXPECT_TRUE(after.outages().empty());
    }
}

TEST(Supervise, GoesOnWithoutADeviceItCanDoWithoutAndSaysSo) {
  for (const char* name : {"colour camera", "compass", "pan unit", "turntable"})
    for (const auto& [health, word] : {std::pair(Health::kOk, "silent"), std::pair(Health::kSilent, "silent"),
                                       std::pair(Health::kFaulty, "unreadable"), std::pair(Health::kAbsent, "gone")}) {
      const SupervisedDevice device = Device(name, false, 10.0, health);
      EXPECT_TRUE(After(device, kHeard + std::chrono::milliseconds(500)).outages().empty());
      const Supervisor after = After(device, kHeard + std::chrono::milliseconds(600));
      EXPECT_EQ(after.stop(), "");
      ASSERT_EQ(after.outages().size(), 1u);
      EXPECT_EQ(after.outages()[0].Sentence(),
                std::string("the ") + name + " was " + word + " from 10.0 s on, and the run went on without it");
    }
}

// Measurements still arrive, but the driver reports that they are unusable.
TEST(Supervise, BelievesABadStatusAlthoughMeasurementsArrive) {
  SupervisedDevice camera = Device("depth camera", true, 20.0, Health::kFaulty);
  camera.heard = kHeard + std::chrono::milliseconds(700);
  EXPECT_EQ(HealthOf(camera, kHeard + std::chrono::milliseconds(500)), Health::kOk);
  EXPECT_EQ(HealthOf(camera, kHeard + std::chrono::milliseconds(700)), Health::kFaulty);
}

// A status that was bad long ago and is ok again has no effect.
TEST(Supervise, ForgivesAHiccup) {
  SupervisedDevice camera = Device("depth camera", true, 20.0);
  camera.status.since = kHeard - std::chrono::seconds(5);
  EXPECT_EQ(HealthOf(camera, kHeard + std::chrono::milliseconds(100)), Health::kOk);
  camera.status = {.health = Health::kAbsent, .since = kHeard + std::chrono::milliseconds(50), .rate_hz = 20.0};
  EXPECT_EQ(HealthOf(camera, kHeard + std::chrono::milliseconds(450)), Health::kOk);
}

TEST(Supervise, NotesEachOutageOnceWithItsEnd) {
  Supervisor supervisor;
  SupervisedDevice devices[] = {Device("depth camera", true, 20.0), Device("compass", false, 10.0),
                                Device("colour camera", false, 10.0)};
  // The compass is heard until 10.0 s and from 12.0 s to 13.0 s, the others always.
  for (Time now = kHeard; now <= std::chrono::seconds(15); now += std::chrono::milliseconds(50)) {
    devices[0].heard = devices[2].heard = now;
    if (now >= std::chrono::seconds(12) && now <= std::chrono::seconds(13)) devices[1].heard = now;
    supervisor.Watch(now, devices);
    EXPECT_EQ(supervisor.stop(), "");
  }
  ASSERT_EQ(supervisor.outages().size(), 2u);
  EXPECT_EQ(supervisor.outages()[0].Sentence(),
            "the compass was silent from 10.0 s to 12.0 s, and the run went on without it");
  EXPECT_EQ(supervisor.outages()[1].Sentence(),
            "the compass was silent from 13.0 s on, and the run went on without it");
  EXPECT_EQ(supervisor.outages()[1].Sentence(std::chrono::milliseconds(2500)),
            "the compass was silent from 10.5 s on, and the run went on without it");
}

TEST(Supervise, NamesTheFirstOfSeveralDevicesThatStopTheCarAndLetsItGoOnceTheyAreBack) {
  Supervisor supervisor;
  SupervisedDevice devices[] = {Device("depth camera", true, 20.0), Device("drive", true, 50.0)};
  supervisor.Watch(kHeard + std::chrono::seconds(1), devices);
  EXPECT_EQ(supervisor.stop(), "the depth camera has been silent for 1.0 s");
  devices[0].heard = kHeard + std::chrono::seconds(1);
  supervisor.Watch(kHeard + std::chrono::seconds(1), devices);
  EXPECT_EQ(supervisor.stop(), "the drive has been silent for 1.0 s");
  devices[1].heard = kHeard + std::chrono::seconds(1);
  supervisor.Watch(kHeard + std::chrono::seconds(1), devices);
  EXPECT_EQ(supervisor.stop(), "");
}

TEST(Supervise, HasNothingToSayOfNoDevices) {
  Supervisor supervisor;
  supervisor.Watch(kHeard, {});
  EXPECT_EQ(supervisor.stop(), "");
  EXPECT_TRUE(supervisor.outages().empty());
}

}  // namespace
}  // namespace merlin
