// What the car is asked to do: the `task` of a scenario file.
#pragma once

#include <string>

namespace merlin {

struct Task {
  std::string behavior = "follow_corridor";  // a name in the table of behaviours (autonomy/behaviors/table.h)
  int laps = 0;                              // [0, 1000] of follow_corridor: rounds until it is done; 0: endless
  double angle_deg = 360.0;                  // [-3600, 3600] of turn_on_turntable, positive to the left
  double rate_deg_s = 20.0;                  // [0.1, 180] at which the turntable turns
};

template <class Visitor>
void Visit(Visitor& v, Task& c) {
  v("behavior", c.behavior);
  v("laps", c.laps, {0.0, 1000.0});
  v("angle_deg", c.angle_deg, {-3600.0, 3600.0});
  v("rate_deg_s", c.rate_deg_s, {0.1, 180.0});
}

}  // namespace merlin
