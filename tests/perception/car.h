// The car of the odometry tests: numbers like MERLIN's.
#pragma once

#include "robot/types/car.h"

namespace merlin {

inline CarDescription Car() {
  CarDescription car;
  car.wheelbase_m = 0.33;
  car.track_m = 0.26;
  car.wheel_radius_m = 0.055;
  car.drivetrain.gear = 10.0;
  car.drivetrain.encoder_counts_per_motor_turn = 512;
  return car;
}

}  // namespace merlin
