#include "scenarios/run/preflight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/scenarios/run/preflight_car.h"

namespace merlin {
namespace {

using Faults = std::vector<std::string>;

constexpr double kDegree = M_PI / 180.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Preflight : public ::testing::Test {
 protected:
  Preflight() { car_.Wired(); }
  Faults AtRest() { return PreflightAtRest(car_.robot(), car_.description); }
  Faults Moving() { return PreflightMoving(car_.robot(), car_.description, stop_); }
  PreflightCar car_;
  std::atomic<bool> stop_{false};
};

TEST_F(Preflight, FindsNothingWrongWithAGoodCar) {
  EXPECT_EQ(AtRest(), Faults{});
  EXPECT_EQ(car_.fastest_m_s, 0.0) << "it moves nothing";
  EXPECT_EQ(Moving(), Faults{});
}

TEST_F(Preflight, FindsEachDeviceThatDeliversHalfOfWhatItShould) {
  const std::pair<Rate*, const char*> rates[] = {
      {&car_.drive, "the drive delivers 25.0 measurements a second; expected 50.0"},
      {&car_.compass, "the compass delivers 6.0 measurements a second; expected 12.5"},
      {&car_.depth, "the depth camera delivers 10.0 measurements a second; expected 20.0"},
      {&car_.color, "the colour camera delivers 5.0 measurements a second; expected 10.0"}};
  for (const auto& [rate, sentence] : rates) {
    rate->true_hz = 0.5 * rate->told_hz;
    const Faults faults = AtRest();
    ASSERT_EQ(faults.size(), 1u) << sentence;
    EXPECT_TRUE(faults[0].starts_with(sentence)) << faults[0];
    rate->true_hz = 2.0 * rate->told_hz;
    EXPECT_EQ(AtRest().size(), 1u) << "too fast: " << sentence;
    rate->true_hz = 0.8 * rate->told_hz;
    EXPECT_EQ(AtRest(), Faults{}) << "within the tolerance: " << sentence;
    rate->true_hz = rate->told_hz;
  }
}

TEST_F(Preflight, FindsADeviceThatDeliversNothingWhetherItsRateIsKnownOrNot) {
  for (const double told_hz : {20.0, 0.0}) {
    car_.depth = Rate(told_hz);
    car_.depth.true_hz = 0.0;
    EXPECT_EQ(AtRest(), Faults{"the depth camera delivers nothing"});
  }
  car_.depth.true_hz = 3.0;  // with an unknown rate any count is accepted
  EXPECT_EQ(AtRest(), Faults{});
}

TEST_F(Preflight, KnowsTheLimitsOfTheBattery) {
  // 0.9 and 1.3 of 12 V
  for (const double good_v : {10.81, 12.0, 15.59}) {
    car_.battery_v = good_v;
    EXPECT_EQ(AtRest(), Faults{}) << good_v;
  }
  for (const double bad_v : {3.0, 10.79, 15.61, 0.0, -12.0, kNan, HUGE_VAL}) {
    car_.battery_v = bad_v;
    EXPECT_EQ(AtRest().size(), 1u) << bad_v;
  }
  car_.battery_v = 3.0;
  EXPECT_EQ(AtRest(), Faults{"the drive reports a battery of 3.0 V; expected 10.8 to 15.6 V for a car of 12.0 V"});
}

TEST_F(Preflight, FindsACompassThatIsNotLevel) {
  for (double* angle_rad : {&car_.roll_rad, &car_.pitch_rad})
    for (const double side : {1.0, -1.0}) {
      *angle_rad = side * 4.9 * kDegree;
      EXPECT_EQ(AtRest(), Faults{});
      *angle_rad = side * 5.1 * kDegree;
      EXPECT_EQ(AtRest().size(), 1u);
      *angle_rad = kNan;
      EXPECT_EQ(AtRest(), Faults{"the compass reads an angle that is not a number"});
      *angle_rad = 0.0;
    }
  car_.roll_rad = 20.0 * kDegree;
  EXPECT_EQ(AtRest(), Faults{"the compass reads roll 20.0 deg, pitch 0.0 deg; expected a car within 5 deg of level"});
}

TEST_F(Preflight, FindsCamerasThatSeeNothing) {
  car_.same_range = car_.one_color = true;
  EXPECT_EQ(AtRest(), (Faults{"the depth camera reads 1.234 m in every pixel: it does not measure",
                              "the colour camera delivers pictures of one colour: is something over its lens?"}));
  car_.same_range = car_.one_color = false;
  car_.no_range = true;
  EXPECT_EQ(AtRest(),
            Faults{"the depth camera delivers frames without a single valid pixel: is something over its lens?"});
}

TEST_F(Preflight, FindsASteeringAngleThatIsNoNumber) {
  car_.servo_reports_rad = HUGE_VAL;
  EXPECT_EQ(AtRest(), Faults{"the drive reports a steering angle that is not a number"});
}

TEST_F(Preflight, TellsAllFaultsAtOnce) {
  car_.battery_v = 3.0;
  car_.roll_rad = 1.0;
  car_.same_range = true;
  car_.color.true_hz = 0.0;
  EXPECT_EQ(AtRest().size(), 4u);
}

TEST_F(Preflight, NamesADeviceWhoseDriverThrows) {
  car_.drive_throws = true;
  EXPECT_EQ(AtRest(), Faults{"drive: the cable is cut"});
  EXPECT_EQ(Moving(), Faults{"drive: the cable is cut"});
}

TEST_F(Preflight, DoesNotAskForDevicesThatTheRobotLacks) {
  Robot robot = car_.robot();
  robot.compass = nullptr;
  robot.color = nullptr;
  EXPECT_EQ(PreflightAtRest(robot, car_.description), Faults{});
  EXPECT_EQ(PreflightMoving(robot, car_.description, stop_), Faults{});
}

TEST_F(Preflight, BringsTheCarBackToWhereItStood) {
  EXPECT_EQ(Moving(), Faults{});
  EXPECT_NEAR(car_.x_m(), 0.0, 0.05);
  EXPECT_NEAR(car_.yaw_rad(), 0.0, 0.05);
  EXPECT_EQ(car_.speed_m_s(), 0.0);
  EXPECT_LT(car_.fastest_m_s, 0.2);
}

TEST_F(Preflight, FindsWheelsThatDoNotTurnOrTurnTheWrongWay) {
  car_.wheels_turn = 0.0;
  EXPECT_EQ(Moving(), Faults{"told to drive +5 cm, the wheels turned by +0.0 cm"});
  car_.wheels_turn = -1.0;
  const Faults faults = Moving();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].starts_with("told to drive +5 cm, the wheels turned by -")) << faults[0];
  EXPECT_EQ(car_.speed_m_s(), 0.0);
}

TEST_F(Preflight, FindsACarThatDrivesOnWhenCommandsStop) {
  car_.ignores_expiry = true;
  const Faults faults = Moving();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].starts_with("the car still drove 0.10 m/s, ")) << faults[0];
  EXPECT_EQ(car_.speed_m_s(), 0.0) << "it is told to stand";
}

TEST_F(Preflight, FindsACompassThatTurnsTheOtherWayOrNotAtAll) {
  for (const double turns : {-1.0, 0.0, 2.0}) {
    car_.compass_turns = turns;
    const Faults faults = Moving();
    ASSERT_EQ(faults.size(), 2u) << turns;  // one per arc
    EXPECT_TRUE(faults[0].starts_with("on an arc to the left the wheels turned the car by +")) << faults[0];
    EXPECT_TRUE(faults[1].starts_with("on an arc to the right the wheels turned the car by -")) << faults[1];
  }
}

TEST_F(Preflight, FindsASteeringServoThatDoesNotFollow) {
  car_.servo_reports_rad = 0.0;
  const Faults faults = Moving();
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0], "told to steer +17 deg, the servo reports +0.0 deg");
}

TEST_F(Preflight, HaltsAtOnceWhenItIsInterrupted) {
  stop_ = true;
  EXPECT_EQ(Moving(), Faults{});
  EXPECT_EQ(car_.fastest_m_s, 0.0);
  EXPECT_EQ(car_.speed_m_s(), 0.0);
}

TEST_F(Preflight, SaysThatTheDriveFellSilentInsteadOfWaitingForEver) {
  car_.drive.true_hz = 0.0;
  EXPECT_EQ(Moving(), Faults{"the drive fell silent"});
}

}  // namespace
}  // namespace merlin
