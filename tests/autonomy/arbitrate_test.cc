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

// Something this far before the car's front.
Observation Blocked(double gap_m) {
  Observation observation = Free();
  for (int i = 0; i < 20; ++i)
    observation.points_base.push_back(
        {.position = {static_cast<float>(0.45 + gap_m), 0.01f * i - 0.1f, 0.3f}, .sigma_m = 0.01f});
  return observation;
}

ManualWish Hand(double speed_m_s, double steering_rad = 0.0) {
  return {.heard = kNow, .held = true, .speed_m_s = speed_m_s, .steering_rad = steering_rad};
}

Arbitration Decide(const ManualWish& wish, const std::optional<DriveCommand>& autonomy, const Observation* seen) {
  return Arbiter(Car(), {}, {}).Decide(kNow, wish, autonomy, seen);
}

const DriveCommand kPilot{.speed_m_s = 0.4, .steering_rad = 0.1, .valid_for = std::chrono::milliseconds(200)};

void ExpectStands(const Arbitration& arbitration, Driver driver) {
  EXPECT_EQ(arbitration.driver, driver) << Name(arbitration.driver);
  EXPECT_EQ(arbitration.command.speed_m_s, 0.0);
  EXPECT_TRUE(std::isfinite(arbitration.command.steering_rad));
}

TEST(Arbiter, LetsTheHandBeatAutonomy) {
  const Observation free = Free();
  ManualWish wish = Hand(0.7, -0.2);
  wish.autonomy = true;
  const Arbitration arbitration = Decide(wish, kPilot, &free);
  EXPECT_EQ(arbitration.driver, Driver::kManual);
  EXPECT_DOUBLE_EQ(arbitration.command.speed_m_s, 0.7);
  EXPECT_DOUBLE_EQ(arbitration.command.steering_rad, -0.2);
  EXPECT_GT(arbitration.command.valid_for, Duration(0));
}

TEST(Arbiter, GivesTheWheelToAutonomyOnlyWhereItIsSwitchedOnAndTheHandIsOff) {
  const Observation free = Free();
  ManualWish wish{.heard = kNow};
  ExpectStands(Decide(wish, kPilot, &free), Driver::kNobody);
  wish.autonomy = true;
  const Arbitration arbitration = Decide(wish, kPilot, &free);
  EXPECT_EQ(arbitration.driver, Driver::kAutonomy);
  EXPECT_EQ(arbitration.command.speed_m_s, kPilot.speed_m_s);
  EXPECT_EQ(arbitration.command.steering_rad, kPilot.steering_rad);
  ExpectStands(Decide(wish, std::nullopt, &free), Driver::kNobody);
}

TEST(Arbiter, StopsTheHandBeforeAnObstacleUnlessItOverrides) {
  const Observation blocked = Blocked(0.4);  // AvoidConfig keeps half a metre
  ExpectStands(Decide(Hand(0.5), std::nullopt, &blocked), Driver::kObstacleStop);
  ManualWish wish = Hand(0.5);
  wish.override_stop = true;
  const Arbitration arbitration = Decide(wish, std::nullopt, &blocked);
  EXPECT_EQ(arbitration.driver, Driver::kManual);
  EXPECT_DOUBLE_EQ(arbitration.command.speed_m_s, 0.5);
}

TEST(Arbiter, SlowsTheHandToWhatStillStopsInTime) {
  const Observation blocked = Blocked(1.5);
  const Arbitration arbitration = Decide(Hand(2.0), std::nullopt, &blocked);
  EXPECT_EQ(arbitration.driver, Driver::kManual);
  EXPECT_NEAR(arbitration.command.speed_m_s, std::sqrt(2.0 * 0.5 * (1.5 - 0.5)), 0.01);
}

TEST(Arbiter, LooksAlongTheArcThatTheHandSteers) {
  const Observation blocked = Blocked(1.0);  // straight ahead: 0.2 m wide, and 0.9 m past it at full steering
  EXPECT_LT(Decide(Hand(1.5, 0.0), std::nullopt, &blocked).command.speed_m_s, 0.8);
  EXPECT_DOUBLE_EQ(Decide(Hand(1.5, 0.43), std::nullopt, &blocked).command.speed_m_s, 1.5);
}

TEST(Arbiter, LetsTheHandBackAwayFromWhatIsAhead) {
  const Observation blocked = Blocked(0.1);
  const Arbitration arbitration = Decide(Hand(-0.5), std::nullopt, &blocked);
  EXPECT_EQ(arbitration.driver, Driver::kManual);
  EXPECT_DOUBLE_EQ(arbitration.command.speed_m_s, -0.5);
  EXPECT_EQ(Decide(Hand(0.0, 0.3), std::nullopt, &blocked).driver, Driver::kManual);  // steers where it stands
}

TEST(Arbiter, StopsAheadWhereItSeesNothing) {
  ExpectStands(Decide(Hand(0.5), std::nullopt, nullptr), Driver::kObstacleStop);
  Observation old = Free();
  old.stamp = kNow - std::chrono::milliseconds(501);
  ExpectStands(Decide(Hand(0.5), std::nullopt, &old), Driver::kObstacleStop);
  old.stamp = kNow - std::chrono::milliseconds(499);
  EXPECT_EQ(Decide(Hand(0.5), std::nullopt, &old).driver, Driver::kManual);
}

TEST(Arbiter, StopsEverythingWhenTheLinkIsSilent) {
  const Observation free = Free();
  ManualWish wish = Hand(0.5);
  wish.autonomy = true;
  for (const bool held : {true, false}) {
    wish.held = held;
    wish.heard = kNow - std::chrono::milliseconds(499);
    EXPECT_GT(Decide(wish, kPilot, &free).command.speed_m_s, 0.0);
    wish.heard = kNow - std::chrono::milliseconds(501);
    ExpectStands(Decide(wish, kPilot, &free), Driver::kNobody);
  }
}

TEST(Arbiter, TakesAWishThatIsNotFiniteForAHandThatIsOff) {
  const Observation free = Free();
  for (const double bad : {kNan, HUGE_VAL, -HUGE_VAL}) {
    ExpectStands(Decide(Hand(bad), std::nullopt, &free), Driver::kNobody);
    ExpectStands(Decide(Hand(0.5, bad), std::nullopt, &free), Driver::kNobody);
  }
}

}  // namespace
}  // namespace merlin
