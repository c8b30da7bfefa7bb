#include "autonomy/arbitrate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/autonomy/car.h"

namespace merlin {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

constexpr Time kNow = std::chrono::seconds(10);

Observation Free() {
  Observation observation;
  observation.stamp = kNow - std::chrono::milliseconds(40);
  return observation;
}

// An obstacle at this distance ahead of the car's front.
Observation Blocked(double gap_m) {
  Observation observation = Free();
  for (int i = 0; i < 20; ++i)
    observation.points_base.push_back(
        {.position = {static_cast<float>(0.45 + gap_m), 0.01f * i - 0.1f, 0.3f}, .sigma_m = 0.01f});
  return observation;
}

ManualCommand Drives(double speed_m_s, double steering_rad = 0.0) {
  return {.heard = kNow, .held = true, .speed_m_s = speed_m_s, .steering_rad = steering_rad};
}

Arbitration Decide(const ManualCommand& manual, const std::optional<DriveCommand>& autonomy, const Observation* seen) {
  return Arbiter(Car(), {}, {}).Decide(kNow, manual, autonomy, seen);
}

const DriveCommand kPilot{.speed_m_s = 0.4, .steering_rad = 0.1, .valid_for = std::chrono::milliseconds(200)};

void ExpectHalt(const Arbitration& arbitration, Driver driver) {
  EXPECT_EQ(arbitration.driver, driver) << Name(arbitration.driver);
  EXPECT_EQ(arbitration.command.speed_m_s, 0.0);
  EXPECT_TRUE(std::isfinite(arbitration.command.steering_rad));
}

TEST(Arbiter, LetsTheOperatorBeatAutonomy) {
  const Observation free = Free();
  ManualCommand manual = Drives(0.7, -0.2);
  manual.autonomy = true;
  const Arbitration arbitration = Decide(manual, kPilot, &free);
  EXPECT_EQ(arbitration.driver, Driver::kManual);
  EXPECT_DOUBLE_EQ(arbitration.command.speed_m_s, 0.7);
  EXPECT_DOUBLE_EQ(arbitration.command.steering_rad, -0.2);
  EXPECT_GT(arbitration.command.valid_for, Duration(0));
}

TEST(Arbiter, LetsAutonomyDriveOnlyWhereItIsSwitchedOnAndTheOperatorDoesNot) {
  const Observation free = Free();
  ManualCommand manual{.heard = kNow};
  ExpectHalt(Decide(manual, kPilot, &free), Driver::kNobody);
  manual.autonomy = true;
  const Arbitration arbitration = Decide(manual, kPilot, &free);
  EXPECT_EQ(arbitration.driver, Driver::kAutonomy);
  EXPECT_EQ(arbitration.command.speed_m_s, kPilot.speed_m_s);
  EXPECT_EQ(arbitration.command.steering_rad, kPilot.steering_rad);
  ExpectHalt(Decide(manual, std::nullopt, &free), Driver::kNobody);
}

TEST(Arbiter, StopsTheOperatorBeforeAnObstacleUnlessItIsOverridden) {
  const Observation blocked = Blocked(0.4);  // AvoidConfig keeps half a metre
  ExpectHalt(Decide(Drives(0.5), std::nullopt, &blocked), Driver::kObstacleStop);
  ManualCommand manual = Drives(0.5);
  manual.override_stop = true;
  const Arbitration arbitration = Decide(manual, std::nullopt, &blocked);
  EXPECT_EQ(arbitration.driver, Driver::kManual);
  EXPECT_DOUBLE_EQ(arbitration.command.speed_m_s, 0.5);
}

TEST(Arbiter, SlowsTheOperatorToWhatStillStopsInTime) {
  const Observation blocked = Blocked(1.5);
  const Arbitration arbitration = Decide(Drives(2.0), std::nullopt, &blocked);
  EXPECT_EQ(arbitration.driver, Driver::kManual);
  EXPECT_NEAR(arbitration.command.speed_m_s, std::sqrt(2.0 * 0.5 * (1.5 - 0.5)), 0.01);
}

TEST(Arbiter, LooksAlongTheArcThatTheOperatorSteers) {
  const Observation blocked = Blocked(1.0);  // straight ahead: 0.2 m wide, and 0.9 m past it at full steering
  EXPECT_LT(Decide(Drives(1.5, 0.0), std::nullopt, &blocked).command.speed_m_s, 0.8);
  EXPECT_DOUBLE_EQ(Decide(Drives(1.5, 0.43), std::nullopt, &blocked).command.speed_m_s, 1.5);
}

TEST(Arbiter, LetsTheOperatorBackAwayFromWhatIsAhead) {
  const Observation blocked = Blocked(0.1);
  const Arbitration arbitration = Decide(Drives(-0.5), std::nullopt, &blocked);
  EXPECT_EQ(arbitration.driver, Driver::kManual);
  EXPECT_DOUBLE_EQ(arbitration.command.speed_m_s, -0.5);
  EXPECT_EQ(Decide(Drives(0.0, 0.3), std::nullopt, &blocked).driver, Driver::kManual);  // steers while it stands
}

TEST(Arbiter, StopsAheadWhereItSeesNothing) {
  ExpectHalt(Decide(Drives(0.5), std::nullopt, nullptr), Driver::kObstacleStop);
  Observation old = Free();
  old.stamp = kNow - std::chrono::milliseconds(501);
  ExpectHalt(Decide(Drives(0.5), std::nullopt, &old), Driver::kObstacleStop);
  old.stamp = kNow - std::chrono::milliseconds(499);
  EXPECT_EQ(Decide(Drives(0.5), std::nullopt, &old).driver, Driver::kManual);
}

TEST(Arbiter, StopsEverythingWhenTheLinkIsSilent) {
  const Observation free = Free();
  ManualCommand manual = Drives(0.5);
  manual.autonomy = true;
  for (const bool held : {true, false}) {
    manual.held = held;
    manual.heard = kNow - std::chrono::milliseconds(499);
    EXPECT_GT(Decide(manual, kPilot, &free).command.speed_m_s, 0.0);
    manual.heard = kNow - std::chrono::milliseconds(501);
    ExpectHalt(Decide(manual, kPilot, &free), Driver::kNobody);
  }
}

TEST(Arbiter, TakesACommandThatIsNotFiniteForNone) {
  const Observation free = Free();
  for (const double bad : {kNan, HUGE_VAL, -HUGE_VAL}) {
    ExpectHalt(Decide(Drives(bad), std::nullopt, &free), Driver::kNobody);
    ExpectHalt(Decide(Drives(0.5, bad), std::nullopt, &free), Driver::kNobody);
  }
}

}  // namespace
}  // namespace merlin
