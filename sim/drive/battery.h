// The car's battery: its voltage under load, and its charge.
#pragma once

#include "robot/types/drivetrain_config.h"

namespace merlin::sim {

// A DC motor behind a lossless H-bridge, averaged over the PWM period: the motor gets duty times the terminal voltage,
// and the battery delivers duty times the motor's current.
struct MotorLoad {
  double duty = 0.0;  // [-1, 1]; at 0 the motor is shorted: it brakes and draws nothing
  double back_emf_v = 0.0;
  double resistance_ohm = 1.0;  // of the winding, > 0

  double Current_a(double terminal_v) const { return (duty * terminal_v - back_emf_v) / resistance_ohm; }
};

class Battery {
 public:
  Battery() = default;
  // nominal_v: cell count times 1.2 V.
  Battery(const BatteryConfig& config, double nominal_v);

  double OpenCircuit_v() const;
  // The terminal voltage under both loads, motor and electronics, with the battery's internal resistance. A motor that
  // brakes against the bridge (duty * current < 0) feeds current back and raises it.
  double Terminal_v(const MotorLoad& motor) const;
  // Draws the charge that motor and electronics use in this time; a braking motor charges the battery.
  void Feed(const MotorLoad& motor, double duration_s);

  // No charge is left; motor and electronics get no more current.
  bool empty() const { return !config_.always_nominal && charge_as_ <= 0.0; }
  double charge() const { return charge_as_ / capacity_as_; }  // share of the capacity

 private:
  double Load_a() const { return empty() ? 0.0 : config_.load_a; }

  BatteryConfig config_;
  double nominal_v_ = 0.0, capacity_as_ = 1.0, charge_as_ = 1.0;
};

}  // namespace merlin::sim
