// Electronics of the steering servo: pulses, hold, dead band, and backlash of the linkage. The slew rate is limited by
// the actuator (sim/drive/drivetrain.h).
//
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
#pragma once

#include "robot/types/drivetrain_config.h"
#include "robot/types/time.h"

namespace merlin::sim {

// Pulse width for a steering angle in [-max, max], and the inverse: 2.0 ms is full left, 1.6 ms straight and 1.0 ms
// full right (thesis), linear in between. So a microsecond turns the wheels further on the left side than on the right.
double PulseOf_us(double steering_rad, double steering_max_rad);
double AngleOf_rad(double pulse_us, double steering_max_rad);

class SteeringServo {
 public:
  SteeringServo() = default;
  SteeringServo(const DrivetrainConfig& config, double steering_max_rad);

  // The target angle of the linkage for a command. A new pulse starts once per period; it moves the servo only if it
  // differs by more than the dead band from the last pulse that did. The linkage follows the servo with its backlash.
  double LinkageTarget_rad(double command_rad, Time now);
  // The angle that the servo reports while the linkage is at linkage_rad.
  double Report_rad(double linkage_rad) const {
    return linkage_rad - config_.steering_offset_rad + (servo_rad_ - linkage_rad_);
  }

 private:
  DrivetrainConfig config_;
  double steering_max_rad_ = 1.0;
  Time next_pulse_{0};
  double servo_rad_ = 0.0;    // target of the last pulse that moved the servo
  double linkage_rad_ = 0.0;  // target of the linkage, without the offset
};

}  // namespace merlin::sim
