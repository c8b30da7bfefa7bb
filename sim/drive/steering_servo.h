// The steering servo as its electronics drive it: pulses, hold, dead band, play in the linkage. Its slew is the actuator's
// (sim/drive/drivetrain.h).
//
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
#pragma once

#include "robot/types/drivetrain_config.h"
#include "robot/types/time.h"

namespace merlin::sim {

// Pulse width for a steering angle in [-max, max], and back: 2.0 ms full left, 1.6 ms straight, 1.0 ms full right (thesis),
// straight lines between. A microsecond to the left turns more than one to the right.
double PulseOf_us(double steering_rad, double steering_max_rad);
double AngleOf_rad(double pulse_us, double steering_max_rad);

class SteeringServo {
 public:
  SteeringServo() = default;
  SteeringServo(const DrivetrainConfig& config, double steering_max_rad);

  // The angle that the linkage is driven to, given the command: a pulse starts only every period and must differ from the
  // last that moved the servo by more than the dead band; the linkage follows the servo through the play.
  double LinkageTarget_rad(double command_rad, Time now);
  // What the servo reports while the linkage is at an angle.
  double Report_rad(double linkage_rad) const {
    return linkage_rad - config_.steering_offset_rad + (servo_rad_ - linkage_rad_);
  }

 private:
  DrivetrainConfig config_;
  double steering_max_rad_ = 1.0;
  Time next_pulse_{0};
  double servo_rad_ = 0.0;    // where the last pulse sends it
  double linkage_rad_ = 0.0;  // where it takes the linkage, the offset apart
};

}  // namespace merlin::sim
