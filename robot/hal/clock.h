// Time as the stack sees it. Waiting steps the world in the twin, jumps ahead in replay, and sleeps on the car.
#pragma once

#include "robot/types/time.h"

namespace merlin {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time Now() const = 0;
  // Returns when Now() >= time; at once if it already is. False: the run is over, nothing more will come.
  virtual bool WaitUntil(Time time) = 0;
};

}  // namespace merlin
