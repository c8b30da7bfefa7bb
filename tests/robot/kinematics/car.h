// The car of the kinematics tests: numbers like MERLIN's.
#pragma once

#include <cmath>
#include <numbers>

#include "robot/types/car.h"

namespace merlin {

inline CarDescription Car() {
  CarDescription car;
  car.wheelbase_m = 0.33;
  car.track_m = 0.26;
  car.steering_track_m = 0.2;
  car.wheel_radius_m = 0.055;
  car.steering_max_rad = 25.0 * std::numbers::pi / 180.0;
  car.drivetrain.gear = 10.0;
  car.drivetrain.encoder_counts_per_motor_turn = 512;
  car.drivetrain.speed_max_m_s = 2.0;
  return car;
}

// The mean path of the four wheels over that of the rear axle's middle, from plane geometry: each wheel's distance from
// the circle's centre, which lies on the line of the rear axle.
inline double MeanOfFourWheels(const CarDescription& car, double wheels_rad) {
  if (wheels_rad == 0.0) return 1.0;
  const double R = car.wheelbase_m / std::tan(std::abs(wheels_rad));
  double sum = 0.0;
  for (const double x : {0.0, car.wheelbase_m})
    for (const double y : {-0.5 * car.track_m, 0.5 * car.track_m}) sum += std::hypot(x, R - y);
  return sum / 4.0 / R;
}

}  // namespace merlin
