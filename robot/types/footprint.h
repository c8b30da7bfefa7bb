// The ground that a car covers: for obstacle avoidance, and for clearing the map where the car drove.
#pragma once

#include "robot/types/car.h"

namespace merlin {

// The outline of the car's collision shapes, measured from base_link.
struct Footprint {
  double front_m = 0.0;       // how far it reaches ahead of base_link,
  double rear_m = 0.0;        // behind it,
  double half_width_m = 0.0;  // and to either side
  double height_m = 0.0;      // of the parts at least half as wide as the car; a mast does not count
};
Footprint FootprintOf(const CarDescription& car);

}  // namespace merlin
