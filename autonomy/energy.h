// Energy supervision: how full the battery is, judged by its voltage at rest, and what follows: it warns, then the car
// stops while it still can. It does not drive home: the pilot knows no way back (it follows corridors, and a car of
// this turning circle cannot turn round in one), so that the way home is left to whoever drives by hand.
#pragma once

#include <optional>

#include "robot/base/config.h"
#include "robot/types/car.h"
#include "robot/types/measurements.h"

namespace merlin {

// Shares of the car's nominal voltage; 0 for the last two: no supervision. Ten cells of nickel-metal-hydride at 12 V
// have about 8 and 4 % of their charge left at the defaults, the electronics' own draw included; guesses.
struct EnergyConfig {
  double resistance_ohm =
      0.08;                  // [0, 10] of battery and leads: what the motor's current makes the voltage sag by; guess
  double filter_s = 2.0;     // [0, 60] time constant of the filter: a start or a bump is no empty battery; guess
  double warn_share = 0.98;  // [0, 2] below it the battery is low
  double stop_share = 0.94;  // [0, 2] below it the car stops
};

template <class Visitor>
void Visit(Visitor& v, EnergyConfig& c) {
  v("resistance_ohm", c.resistance_ohm, {0.0, 10.0});
  v("filter_s", c.filter_s, {0.0, 60.0});
  v("warn_share", c.warn_share, {0.0, 2.0});
  v("stop_share", c.stop_share, {0.0, 2.0});
}

enum class EnergyLevel { kEnough, kLow, kEmpty };

// What the battery's voltage would be without the motor [V]: the motor draws from it, by the power it takes from the
// bridge, current * (R current + K shaft speed) / voltage. shaft_rad_s: of the motor.
double RestVoltage_v(const DriveState& state, double shaft_rad_s, const Drivetrain& drivetrain, double resistance_ohm);

class Energy {
 public:
  Energy(const CarDescription& car, const EnergyConfig& config) : drivetrain_(car.drivetrain), config_(config) {}

  // States in order of stamps; one that is not finite is left out.
  void Update(const DriveState& state);

  // It only falls: a battery does not fill on the way, though its voltage recovers when the car stands.
  EnergyLevel level() const { return level_; }
  std::optional<double> rest_v() const { return rest_v_; }  // filtered; nothing before the second state
  double stop_v() const { return config_.stop_share * drivetrain_.voltage_max_v; }

 private:
  void Judge();

  Drivetrain drivetrain_;
  EnergyConfig config_;
  std::optional<DriveState> last_;
  std::optional<double> rest_v_;
  EnergyLevel level_ = EnergyLevel::kEnough;
};

}  // namespace merlin
