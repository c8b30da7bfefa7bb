// Energy supervision: how full the battery is, and what follows from that.
//
// The voltage of the battery sags while the motor draws current, so that the voltage at rest is computed from what the
// drive reports, and filtered. Below a first limit the battery is low and the user is warned; below a second one it is
// empty, and the car stops while it still can. It does not drive home: the pilot knows no path back (it follows corridors,
// and a car with this turning circle cannot turn round in one). Whoever operates the car by hand may still bring it home.
#pragma once

#include <optional>

#include "robot/base/config.h"
#include "robot/types/car.h"
#include "robot/types/measurements.h"

namespace merlin {

// The shares are of the car's nominal voltage; 0 for both switches the supervision off. At the defaults, ten cells of
// nickel-metal-hydride (12 V) have about 8 and 4 % of their charge left, the draw of the electronics included; guesses.
struct EnergyConfig {
  double resistance_ohm = 0.08;  // [0, 10] of battery and leads, which makes the voltage sag with the current; guess
  double filter_s =
      2.0;  // [0, 60] time constant of the filter, so that a start or a bump is not taken for an empty battery; guess
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

// What the voltage of the battery would be if the motor drew nothing [V]. The current that the motor draws from the battery
// follows from the power it takes from the bridge: current * (R current + K shaft speed) / voltage.
// shaft_rad_s: speed of the motor shaft. resistance_ohm: of battery and leads.
double RestVoltage_v(const DriveState& state, double shaft_rad_s, const Drivetrain& drivetrain, double resistance_ohm);

class Energy {
 public:
  Energy(const CarDescription& car, const EnergyConfig& config) : drivetrain_(car.drivetrain), config_(config) {}

  // States in order of their stamps. One that is not finite, or not newer than the last, is ignored.
  void Update(const DriveState& state);

  // It only falls: a battery does not fill while driving, though its voltage recovers when the car stands.
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
