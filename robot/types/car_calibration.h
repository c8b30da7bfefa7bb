// The numbers of a car that are measured better by driving a known course than by reading its drawing.
#pragma once

#include "robot/base/config.h"
#include "robot/types/car.h"

namespace merlin {

struct CarCalibration {
  double wheel_radius_m = 0.055;     // [0.005, 1] all four: as they roll under the car's load
  double wheelbase_m = 0.33;         // [0.05, 5]
  double steering_offset_rad = 0.0;  // [-0.3, 0.3] of the wheels from what the servo reports, positive: left of it
};

template <class Visitor>
void Visit(Visitor& v, CarCalibration& c) {
  v("wheel_radius_m", c.wheel_radius_m, {0.005, 1.0});
  v("wheelbase_m", c.wheelbase_m, {0.05, 5.0});
  v("steering_offset_rad", c.steering_offset_rad, {-0.3, 0.3});
}

// The car with the calibrated numbers, for the stack. Its links keep the poses of the URDF.
inline CarDescription Calibrated(CarDescription car, const CarCalibration& calibration) {
  car.wheel_radius_m = calibration.wheel_radius_m;
  car.wheelbase_m = calibration.wheelbase_m;
  car.steering_offset_rad = calibration.steering_offset_rad;
  return car;
}

}  // namespace merlin
