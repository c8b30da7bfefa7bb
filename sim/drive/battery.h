// The car's battery: its voltage under load, and how long it lasts.
#pragma once

#include "robot/types/drivetrain_config.h"

namespace merlin::sim {

// A DC motor behind an H-bridge, averaged over the PWM: it sees duty times the terminal voltage, and what it draws loads
// the battery with duty times its current: no power is lost or made in the bridge.
struct MotorLoad {
  double duty = 0.0;  // [-1, 1]; 0: shorted, it brakes and draws nothing
  double back_emf_v = 0.0;
  double resistance_ohm = 1.0;  // of the winding, > 0

  double Current_a(double terminal_v) const { return (duty * terminal_v - back_emf_v) / resistance_ohm; }
};

class Battery {
 public:
  Battery() = default;
  // nominal_v: of ten cells at 1.2 V, for the others in proportion.
  Battery(const BatteryConfig& config, double nominal_v);

  double OpenCircuit_v() const;
  // Under the motor and the electronics: both loads and the inner resistance solved together. A motor that brakes against
  // the bridge (duty * current < 0) feeds back and raises it.
  double Terminal_v(const MotorLoad& motor) const;
  // The charge that this takes, or brings back, in a time.
  void Feed(const MotorLoad& motor, double duration_s);

  // Nothing is left: neither the motor nor the electronics get anything any more.
  bool empty() const { return !config_.always_nominal && charge_as_ <= 0.0; }
  double charge() const { return charge_as_ / capacity_as_; }  // share of the capacity

 private:
  double Load_a() const { return empty() ? 0.0 : config_.load_a; }

  BatteryConfig config_;
  double nominal_v_ = 0.0, capacity_as_ = 1.0, charge_as_ = 1.0;
};

}  // namespace merlin::sim
