// Battery, servo pulses and encoder alone, compared with formulas and counts that one can check by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/drive/battery.h"
#include "sim/drive/encoder.h"
#include "sim/drive/steering_servo.h"

namespace merlin::sim {
namespace {

using std::numbers::pi;

constexpr double kMax_rad = 25.0 * pi / 180.0;

TEST(Battery, SagsByItsResistanceTimesTheCurrent) {
  const Battery battery({.capacity_ah = 1.0, .charge = 0.5, .resistance_ohm = 0.2, .load_a = 2.0}, 12.0);
  EXPECT_NEAR(battery.OpenCircuit_v(), 12.0 * 1.06, 1e-12);  // a knot of the curve: 1.272 V per cell at half charge
  EXPECT_NEAR(battery.Terminal_v({}), battery.OpenCircuit_v() - 0.2 * 2.0, 1e-12);
  for (const double duty : {1.0, -1.0, 0.4})
    for (const double emf_v : {0.0, 3.0, -11.0}) {
      const MotorLoad motor{.duty = duty, .back_emf_v = emf_v, .resistance_ohm = 0.6};
      const double terminal_v = battery.Terminal_v(motor);
      EXPECT_NEAR(terminal_v, battery.OpenCircuit_v() - 0.2 * (2.0 + duty * motor.Current_a(terminal_v)), 1e-12);
    }
}

TEST(Battery, RisesWhenABrakingMotorFeedsItBack) {
  Battery battery({.capacity_ah = 1.0, .charge = 0.5, .resistance_ohm = 0.2, .load_a = 0.0}, 12.0);
  const MotorLoad braking{.duty = 0.5, .back_emf_v = 9.0, .resistance_ohm = 0.6};
  EXPECT_GT(battery.Terminal_v(braking), battery.OpenCircuit_v());
  const double before = battery.charge();
  battery.Feed(braking, 1.0);
  EXPECT_GT(battery.charge(), before);
}

TEST(Battery, LosesTheChargeThatIsDrawnAndIsThenEmptyForGood) {
  Battery battery({.capacity_ah = 1.0, .charge = 1.0, .resistance_ohm = 0.1, .load_a = 2.0}, 12.0);
  double before_v = battery.OpenCircuit_v();
  for (int minute = 0; minute < 30; ++minute) {
    EXPECT_NEAR(battery.charge(), 1.0 - minute / 30.0, 1e-9);  // 2 A empty 1 Ah in half an hour
    EXPECT_FALSE(battery.empty());
    EXPECT_LE(battery.OpenCircuit_v(), before_v);
    before_v = battery.OpenCircuit_v();
    battery.Feed({}, 60.0);
  }
  battery.Feed({}, 1e-3);  // thirty shares need not add up to exactly one
  EXPECT_TRUE(battery.empty());
  EXPECT_EQ(battery.charge(), 0.0);
  EXPECT_NEAR(battery.Terminal_v({}), 0.83 * 12.0, 1e-9);  // there is no load any more
}

TEST(Battery, NeitherOverfillsNorGivesNegativeVoltage) {
  Battery full({.charge = 1.0, .load_a = 0.0}, 12.0);
  full.Feed({.duty = 0.1, .back_emf_v = 12.0, .resistance_ohm = 0.6}, 3600.0);
  EXPECT_EQ(full.charge(), 1.0);
  EXPECT_EQ(Battery({.resistance_ohm = 10.0, .load_a = 100.0}, 12.0).Terminal_v({}), 0.0);
}

TEST(Battery, IsConstantAsALaboratorySupply) {
  Battery supply({.always_nominal = true, .charge = 0.0, .resistance_ohm = 1.0, .load_a = 9.0}, 7.2);
  supply.Feed({.duty = 1.0}, 1e6);
  EXPECT_EQ(supply.Terminal_v({.duty = 1.0}), 7.2);
  EXPECT_FALSE(supply.empty());
}

TEST(SteeringPulse, IsPiecewiseLinearAroundSixteenHundredMicroseconds) {
  EXPECT_DOUBLE_EQ(PulseOf_us(0.0, kMax_rad), 1600.0);
  EXPECT_DOUBLE_EQ(PulseOf_us(kMax_rad, kMax_rad), 2000.0);
  EXPECT_DOUBLE_EQ(PulseOf_us(-kMax_rad, kMax_rad), 1000.0);
  EXPECT_DOUBLE_EQ(PulseOf_us(0.5 * kMax_rad, kMax_rad), 1800.0);
  EXPECT_DOUBLE_EQ(PulseOf_us(-0.5 * kMax_rad, kMax_rad), 1300.0);
  for (const double share : {-1.0, -0.3, -1e-9, 0.0, 1e-9, 0.7, 1.0})
    EXPECT_NEAR(AngleOf_rad(PulseOf_us(share * kMax_rad, kMax_rad), kMax_rad), share * kMax_rad, 1e-12);
}

TEST(SteeringServo, TakesOnePulseEveryPeriodAndHoldsIt) {
  SteeringServo servo({.steering_backlash_rad = 0.0}, kMax_rad);
  double held_rad = servo.LinkageTarget_rad(0.0, Time{0});
  for (int ms = 2; ms < 200; ms += 2) {
    const double target_rad = servo.LinkageTarget_rad(0.001 * ms, std::chrono::milliseconds(ms));
    if (ms % 20 == 0) held_rad = 0.001 * ms;  // 20 ms change the command by 0.02 rad: 18 us
    EXPECT_NEAR(target_rad, held_rad, 1e-12) << ms;
  }
}

// A microsecond turns 25/400 deg to the left, but 25/600 deg to the right.
TEST(SteeringServo, IgnoresWhatLiesInTheDeadBand) {
  for (const double sign : {1.0, -1.0}) {
    SteeringServo servo({.servo_dead_band_us = 5.0, .steering_backlash_rad = 0.0}, kMax_rad);
    const double band_rad = 5.0 * kMax_rad / (sign > 0.0 ? 400.0 : 600.0);
    EXPECT_EQ(servo.LinkageTarget_rad(0.99 * sign * band_rad, Time{0}), 0.0);
    const double beyond_rad = 1.01 * sign * band_rad;
    EXPECT_NEAR(servo.LinkageTarget_rad(beyond_rad, std::chrono::milliseconds(20)), beyond_rad, 1e-12);
    EXPECT_NEAR(servo.LinkageTarget_rad(0.02 * sign * band_rad, std::chrono::milliseconds(40)), beyond_rad, 1e-12);
  }
}

TEST(SteeringServo, LeavesTheLinkageBehindByHalfThePlayAndReportsItself) {
  SteeringServo servo({.steering_backlash_rad = 0.02, .steering_offset_rad = 0.05}, kMax_rad);
  Time now{0};
  const auto target_rad = [&](double command_rad) {
    const double linkage_rad = servo.LinkageTarget_rad(command_rad, now);
    now += std::chrono::milliseconds(20);
    EXPECT_NEAR(servo.Report_rad(linkage_rad), command_rad, 1e-12);  // it measures neither backlash nor offset
    return linkage_rad - 0.05;
  };
  EXPECT_NEAR(target_rad(0.2), 0.19, 1e-12);
  EXPECT_NEAR(target_rad(0.181), 0.19, 1e-12);  // back within the backlash: the wheels stay
  EXPECT_NEAR(target_rad(0.15), 0.16, 1e-12);
  EXPECT_NEAR(target_rad(-0.2), -0.19, 1e-12);
}

constexpr int kPerTurn = 512;
constexpr double kRotor_kg_m2 = 2e-5, kStep_s = 0.002;

TEST(Encoder, CountsWholeCountsForthAndBack) {
  DrivetrainConfig config{.gear_backlash_rad = 0.0};
  Encoder encoder(config, kPerTurn, kRotor_kg_m2, 1);
  encoder.Follow(2.0 * pi * 3.0, 0.0, kStep_s);
  EXPECT_EQ(encoder.counts(), 3 * kPerTurn);
  encoder.Follow(2.0 * pi * (3.0 + 0.4 / kPerTurn), 0.0, kStep_s);
  EXPECT_EQ(encoder.counts(), 3 * kPerTurn);
  encoder.Follow(2.0 * pi * -1.0, 0.0, kStep_s);
  EXPECT_EQ(encoder.counts(), -kPerTurn);
}

TEST(Encoder, RunsThroughThePlayWhenTheTorqueTurns) {
  constexpr double kPlay_rad = 0.2;
  Encoder encoder({.gear_backlash_rad = kPlay_rad}, kPerTurn, kRotor_kg_m2, 1);
  const auto settle = [&](double torque_n_m) {
    for (int i = 0; i < 100; ++i) encoder.Follow(0.0, torque_n_m, kStep_s);
    return encoder.counts();
  };
  const std::int64_t half = std::llround(0.5 * kPlay_rad * kPerTurn / (2.0 * pi));
  EXPECT_EQ(settle(0.1), half);  // the wheels do not move in the meantime
  EXPECT_EQ(settle(-0.1), -half);
  EXPECT_EQ(settle(0.01), -half);  // below the friction of the bearings
}

// The number of missed edges is binomial: n edges, each missed with probability p. Tolerance: four standard deviations.
TEST(Encoder, MissesTheConfiguredShareOfCounts) {
  constexpr double kShare = 0.01;
  constexpr int kSteps = 20000, kEdges = 50;
  DrivetrainConfig config{.gear_backlash_rad = 0.0, .missed_counts = kShare};
  const auto counts = [&](std::uint64_t seed) {
    Encoder encoder(config, kPerTurn, kRotor_kg_m2, seed);
    for (int i = 1; i <= kSteps; ++i) encoder.Follow(2.0 * pi * i * kEdges / kPerTurn, 0.0, kStep_s);
    return encoder.counts();
  };
  const double n = 1.0 * kSteps * kEdges;
  EXPECT_NEAR(static_cast<double>(counts(1)), n * (1.0 - kShare), 4.0 * std::sqrt(n * kShare * (1.0 - kShare)));
  EXPECT_EQ(counts(1), counts(1));
  EXPECT_NE(counts(1), counts(2));
  config.missed_counts = 0.0;
  EXPECT_EQ(counts(1), static_cast<std::int64_t>(n));
}

}  // namespace
}  // namespace merlin::sim
