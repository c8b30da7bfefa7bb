// The car of the autonomy tests: a box of 0.9 x 0.3 x 0.2 m on its rear axle.
#pragma once

#include <numbers>

#include "robot/types/car.h"

namespace merlin {

inline CarDescription Car() {
  CarDescription car;
  car.wheelbase_m = 0.33;
  car.steering_max_rad = 25.0 * std::numbers::pi / 180.0;
  car.links.resize(1);
  car.links[0].name = "base_link";
  car.links[0].collision.resize(1);
  car.links[0].collision[0].size_m = {0.9, 0.3, 0.2};
  return car;
}

}  // namespace merlin
