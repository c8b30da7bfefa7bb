#include "autonomy/energy.h"

#include <algorithm>
#include <cmath>

#include "robot/kinematics/motion.h"

namespace merlin {

double RestVoltage_v(const DriveState& state, double shaft_rad_s, const Drivetrain& drivetrain, double resistance_ohm) {
  const double current_a = std::abs(state.current_a);
  const double motor_v = drivetrain.resistance_ohm * state.current_a + drivetrain.motor_constant_v_s * shaft_rad_s;
  const double power_w = motor_v * state.current_a;
  // The bridge never draws more from the battery than the motor takes; a battery of 0 V gives nothing.
  const double drawn_a = state.battery_v > 0.0 ? std::clamp(power_w / state.battery_v, -current_a, current_a) : 0.0;
  return state.battery_v + resistance_ohm * drawn_a;
}

void Energy::Update(const DriveState& state) {
  if (!std::isfinite(state.battery_v) || !std::isfinite(state.current_a)) return;
  const std::optional<DriveState> before = last_;
  if (before && state.stamp <= before->stamp) return;
  last_ = state;
  if (!before) return;
  const double period_s = Seconds(state.stamp - before->stamp);
  const double shaft_rad_s = ShaftSpeed_rad_s(drivetrain_, state.encoder_counts - before->encoder_counts, period_s);
  const double rest_v = RestVoltage_v(state, shaft_rad_s, drivetrain_, config_.resistance_ohm);
  const double share = config_.filter_s > 0.0 ? 1.0 - std::exp(-period_s / config_.filter_s) : 1.0;
  rest_v_ = rest_v_ ? *rest_v_ + share * (rest_v - *rest_v_) : rest_v;
  Judge();
}

void Energy::Judge() {
  if (*rest_v_ < config_.warn_share * drivetrain_.voltage_max_v) level_ = std::max(level_, EnergyLevel::kLow);
  if (*rest_v_ < stop_v()) level_ = EnergyLevel::kEmpty;
}

}  // namespace merlin
