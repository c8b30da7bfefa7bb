// The twin's car behind the emulated microcontroller, in simulated time: whatever happens to the line while the stack
// keeps commanding, the motor is braked within 200 ms and the car stands within 0.2 s + v / (2 m/s^2).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/robot/emulated/microcontroller_line.h"
#include "tests/sim/world/car_world.h"

namespace merlin {
namespace {

using std::chrono::milliseconds;

// The emulated robot's car without its cameras.
class WorldCar {
 public:
  void Step(Time now) {
    while (world_->Now() + sim::World::kStep <= now) world_->Step();
  }
  EmulatedCar Wired() {
    return {.send = [this](const DriveCommand& command) { world_->drive().Send(command, world_->Now()); },
            .read = [this] { return sim::Read(*world_); }};
  }
  bool braked() const { return sim::Read(*world_).expired; }
  double Speed_m_s() const { return world_->Speed_m_s(); }

 private:
  std::unique_ptr<sim::World> world_ = sim::EmptyWorld();
};

using Line = MicrocontrollerLine<WorldCar>;

DriveCommand Go(double speed_m_s, double steering_rad = 0.0, Duration valid_for = milliseconds(300)) {
  return {.speed_m_s = speed_m_s, .steering_rad = steering_rad, .valid_for = valid_for};
}

// What goes wrong while the car drives.
struct Trouble {
  const char* name;
  LineFault fault{};                      // of the line
  std::optional<DriveCommand> command{};  // that the stack goes on with
  bool unplugged = false;                 // and the host knows
};

const double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

const std::vector<Trouble> kTroubles{
    {.name = "CommandThatHasExpired", .command = Go(0.8, 0.0, Duration(0))},
    {.name = "CommandOfLongAgo", .command = Go(0.8, 0.0, Duration::min())},
    {.name = "SpeedNotANumber", .command = Go(kNaN, 0.0, std::chrono::seconds(10))},
    {.name = "SteeringNotANumber", .command = Go(0.8, kNaN, std::chrono::seconds(10))},
    {.name = "InfiniteSpeed", .command = Go(kInfinity, 0.0, std::chrono::seconds(10))},
    {.name = "InfiniteSteering", .command = Go(0.8, -kInfinity, Duration::max())},
    {.name = "HugeSpeedThatHasExpired", .command = Go(1e300, 1e300, Duration(-1))},
    {.name = "SilentLine", .fault = Silence(), .command = Go(0.8)},
    {.name = "Garbage", .fault = Garbage(), .command = Go(0.8)},
    {.name = "HalvesOfFrames", .fault = Halves(), .command = Go(0.8)},
    {.name = "DuplicatesOfAnOldCommand", .fault = Duplicates(), .command = Go(0.8, 0.0, milliseconds(150))},
    {.name = "LateCommands", .fault = Late(milliseconds(400)), .command = Go(0.8)},
    {.name = "PulledPlug", .fault = Silence(), .command = Go(0.8, 0.0, std::chrono::hours(1)), .unplugged = true}};

class EmulatedStop : public ::testing::TestWithParam<double> {};

// For each speed, forwards and backwards.
TEST_P(EmulatedStop, BrakesWithin200MillisecondsAndStandsInTimeWhateverHappens) {
  for (const Trouble& trouble : kTroubles) {
    SCOPED_TRACE(trouble.name);
    Line line;
    line.Run(milliseconds(1500), Go(GetParam()));
    const double speed_m_s = line.car.Speed_m_s();
    ASSERT_NEAR(speed_m_s, GetParam(), 0.05);
    line.fault = trouble.fault;
    if (trouble.unplugged) line.host.Disconnected(line.now);
    const Time begin = line.now;
    std::optional<DriveCommand> command = trouble.command;
    if (command && std::isfinite(command->speed_m_s)) command->speed_m_s = std::copysign(command->speed_m_s, speed_m_s);
    line.Run(milliseconds(200) + FromSeconds(std::abs(speed_m_s) / 2.0), command);
    EXPECT_LE(line.last_driven - begin, milliseconds(200));
    EXPECT_LT(std::abs(line.car.Speed_m_s()), 0.01);
    line.Run(milliseconds(500), command);
    EXPECT_LT(std::abs(line.car.Speed_m_s()), 0.01);  // nothing sets it going again
    EXPECT_TRUE(line.car.braked());
  }
}

// When the fault is over, it drives again with the next good command.
TEST_P(EmulatedStop, DrivesAgainWhenTheTroubleIsOver) {
  for (const Trouble& trouble : kTroubles) {
    SCOPED_TRACE(trouble.name);
    Line line;
    line.Run(milliseconds(500), Go(GetParam()));
    line.fault = trouble.fault;
    if (trouble.unplugged) line.host.Disconnected(line.now);
    line.Run(milliseconds(1500), trouble.command);
    line.fault = {};
    if (trouble.unplugged) line.host.Connected(line.now);
    line.Run(milliseconds(1500), Go(GetParam()));
    EXPECT_NEAR(line.car.Speed_m_s(), GetParam(), 0.05);
    EXPECT_EQ(line.host.status().health, DeviceStatus::Health::kOk);
  }
}

TEST_P(EmulatedStop, StandsInTimeWhenTheStackFallsSilent) {
  Line line;
  line.Run(milliseconds(1500), Go(GetParam()));
  const double speed_m_s = line.car.Speed_m_s();
  const Time expiry = line.now - milliseconds(50) + milliseconds(300);  // sent last 50 ms ago
  line.Run(expiry - line.now + milliseconds(200) + FromSeconds(std::abs(speed_m_s) / 2.0));
  EXPECT_LE(line.last_driven - expiry, milliseconds(200));
  EXPECT_LT(std::abs(line.car.Speed_m_s()), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Speeds, EmulatedStop, ::testing::Values(0.8, -0.8, 2.0),
                         [](const auto& test) { return "Case" + std::to_string(test.index); });

TEST(EmulatedCarLine, HugeSpeedsAreTheCarsOwnAndEndLikeAnyOther) {
  Line line;
  line.Run(milliseconds(2000), Go(1e300));
  EXPECT_NEAR(line.car.Speed_m_s(), sim::Merlin().drivetrain.speed_max_m_s, 0.1);
  const double speed_m_s = line.car.Speed_m_s();
  line.host.Command({}, line.now);
  line.Run(milliseconds(200) + FromSeconds(speed_m_s / 2.0));
  EXPECT_LT(std::abs(line.car.Speed_m_s()), 0.01);
}

// A stack out of control: the line carries as much as it can, the newest commands, and they expire in time.
TEST(EmulatedCarLine, AFloodOfCommandsEndsWithItsNewest) {
  Line line;
  for (int i = 0; i < 1500; ++i) {
    for (int k = 0; k < 100; ++k) line.host.Command(Go(k % 2 == 0 ? -0.8 : 0.8), line.now);
    line.Run(Line::kTick);
  }
  const double speed_m_s = line.car.Speed_m_s();
  EXPECT_NEAR(speed_m_s, 0.8, 0.05);
  const Time expiry = line.now - Line::kTick + milliseconds(300);
  line.Run(milliseconds(300 + 200) + FromSeconds(speed_m_s / 2.0));
  EXPECT_LE(line.last_driven - expiry, milliseconds(200));
  EXPECT_LT(std::abs(line.car.Speed_m_s()), 0.01);
}

}  // namespace
}  // namespace merlin
