// Steel in the building bends the magnetic field that a compass reads.
#pragma once

#include "robot/base/config.h"

namespace merlin {

// A piece of steel in a wall or floor. It turns the heading by bend_rad right at it, and by bend_rad exp(-1/2 (distance
// / reach)^2) farther away.
struct Steel {
  double x_m = 0.0, y_m = 0.0;  // in the room's frame
  double reach_m = 1.0;         // [0.05, 100]
  double bend_rad = 0.2;  // [-3, 3] of the heading right at it; corridors of reinforced concrete: 2-20 deg (guess)
};

template <class Visitor>
void Visit(Visitor& v, Steel& c) {
  v("x_m", c.x_m, {-1e4, 1e4});
  v("y_m", c.y_m, {-1e4, 1e4});
  v("reach_m", c.reach_m, {0.05, 100.0});
  v("bend_rad", c.bend_rad, {-3.0, 3.0});
}

}  // namespace merlin
