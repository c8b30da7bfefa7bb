#include "robot/kinematics/limits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/robot/kinematics/car.h"

namespace merlin {
namespace {

TEST(Limits, LeaveWhatTheCarCanDo) {
  const DriveCommand command{.speed_m_s = -1.5, .steering_rad = 0.2, .valid_for = std::chrono::milliseconds(300)};
  const DriveCommand clamped = ClampCommand(Car(), command);
  EXPECT_EQ(clamped.speed_m_s, -1.5);
  EXPECT_EQ(clamped.steering_rad, 0.2);
  EXPECT_EQ(clamped.valid_for, command.valid_for);
}

TEST(Limits, ClampSpeedAndSteeringToBothSides) {
  for (const double side : {1.0, -1.0}) {
    const DriveCommand clamped =
        ClampCommand(Car(), {.speed_m_s = side * 9.0, .steering_rad = -side * 9.0, .valid_for = Duration(1)});
    EXPECT_EQ(clamped.speed_m_s, side * 2.0);
    EXPECT_EQ(clamped.steering_rad, -side * Car().steering_max_rad);
    EXPECT_EQ(ClampSteering_rad(Car(), side * HUGE_VAL), side * Car().steering_max_rad);
  }
}

TEST(SpeedToStopWithin, IsWhatEvenBrakingNeeds) {
  // From 1 m/s at 0.5 m/s^2: two seconds at 0.5 m/s on average.
  EXPECT_DOUBLE_EQ(SpeedToStopWithin_m_s(1.0, 0.5), 1.0);
  EXPECT_NEAR(SpeedToStopWithin_m_s(0.4, 0.5), std::sqrt(0.4), 1e-12);
  EXPECT_EQ(SpeedToStopWithin_m_s(0.0, 0.5), 0.0);
  EXPECT_EQ(SpeedToStopWithin_m_s(-1.0, 0.5), 0.0);
  EXPECT_EQ(SpeedToStopWithin_m_s(HUGE_VAL, 0.5), HUGE_VAL);
}

}  // namespace
}  // namespace merlin
