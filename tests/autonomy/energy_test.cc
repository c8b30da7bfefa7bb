#include "autonomy/energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace merlin {
namespace {

CarDescription CarWithMotor() {
  CarDescription car;
  car.drivetrain.voltage_max_v = 12.0;
  car.drivetrain.motor_constant_v_s = 0.05;
  car.drivetrain.resistance_ohm = 0.5;
  car.drivetrain.encoder_counts_per_motor_turn = 500;
  return car;
}

DriveState At(double t_s, double battery_v, double current_a = 0.0, std::int64_t counts = 0) {
  return {.stamp = FromSeconds(t_s), .encoder_counts = counts, .current_a = current_a, .battery_v = battery_v};
}

// A battery of 12 V and 0.1 ohm that feeds the motor of CarWithMotor() through a bridge, solved by hand in the opposite
// direction: from the duty to the values in the state.
TEST(RestVoltage, IsThatOfTheBatteryBeforeItsResistance) {
  const double emf_v = 100.0 * 0.05;
  for (const double duty : {-0.8, 0.0, 0.3, 0.6, 1.0}) {
    // V = 12 - 0.1 duty I, I = (duty V - emf) / 0.5
    const double battery_v = (12.0 + 0.1 * duty * emf_v / 0.5) / (1.0 + 0.1 * duty * duty / 0.5);
    const double current_a = (duty * battery_v - emf_v) / 0.5;
    EXPECT_NEAR(RestVoltage_v(At(0.0, battery_v, current_a), 100.0, CarWithMotor().drivetrain, 0.1), 12.0, 1e-9)
        << duty;
  }
  EXPECT_DOUBLE_EQ(RestVoltage_v(At(0.0, 0.0, 3.0), 0.0, CarWithMotor().drivetrain, 0.1), 0.0);
  EXPECT_TRUE(std::isfinite(RestVoltage_v(At(0.0, 1e-300, 3.0), 0.0, CarWithMotor().drivetrain, 0.1)));
}

EnergyLevel After(double battery_v, double current_a, double seconds, const EnergyConfig& config = {}) {
  Energy energy(CarWithMotor(), config);
  energy.Update(At(0.0, 12.5));
  energy.Update(At(0.02, 12.5));
  for (int i = 2; i * 0.02 <= seconds; ++i) energy.Update(At(i * 0.02, battery_v, current_a));
  return energy.level();
}

TEST(Energy, WarnsThenStops) {
  EXPECT_EQ(After(12.5, 0.0, 20.0), EnergyLevel::kEnough);
  EXPECT_EQ(After(11.5, 0.0, 20.0), EnergyLevel::kLow);    // of 12 V: below 11.76
  EXPECT_EQ(After(11.0, 0.0, 20.0), EnergyLevel::kEmpty);  // below 11.28
  EXPECT_EQ(After(11.0, 0.0, 20.0, {.warn_share = 0.0, .stop_share = 0.0}), EnergyLevel::kEnough);
}

TEST(Energy, IgnoresAShortDipAndTheSagUnderLoad) {
  EXPECT_EQ(After(10.0, 0.0, 0.3), EnergyLevel::kEnough);
  // 24 A through a blocked motor of 0.5 ohm are 12 V at the motor: all of them through the battery, 1.92 V of sag.
  EXPECT_EQ(After(10.2, 24.0, 20.0), EnergyLevel::kEnough);
  EXPECT_EQ(After(10.2, 24.0, 20.0, {.resistance_ohm = 0.0}), EnergyLevel::kEmpty);
}

TEST(Energy, StaysLowWhenTheVoltageRecovers) {
  Energy energy(CarWithMotor(), {.filter_s = 0.0});
  energy.Update(At(0.0, 11.0));
  EXPECT_FALSE(energy.rest_v());
  energy.Update(At(0.02, 11.0));
  EXPECT_EQ(energy.level(), EnergyLevel::kEmpty);
  energy.Update(At(0.04, 12.5));
  EXPECT_EQ(energy.level(), EnergyLevel::kEmpty);
  EXPECT_DOUBLE_EQ(*energy.rest_v(), 12.5);
}

TEST(Energy, LeavesOutStatesThatAreNotFiniteOrNotNew) {
  Energy energy(CarWithMotor(), {.filter_s = 0.0});
  energy.Update(At(1.0, 12.5));
  energy.Update(At(2.0, 12.5));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  energy.Update(At(3.0, nan));
  energy.Update(At(4.0, 12.5, nan));
  energy.Update(At(2.0, 1.0));
  energy.Update(At(0.5, 1.0));
  EXPECT_EQ(energy.level(), EnergyLevel::kEnough);
  EXPECT_DOUBLE_EQ(*energy.rest_v(), 12.5);
  energy.Update(At(5.0, 0.0));
  EXPECT_EQ(energy.level(), EnergyLevel::kEmpty);
}

}  // namespace
}  // namespace merlin
