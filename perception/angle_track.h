// The angle of something that turns (pan unit, turntable) at any instant of the last second, from its readings.
#pragma once

#include <deque>
#include <optional>

#include "robot/types/measurements.h"

namespace merlin {

class AngleTrack {
 public:
  // In order of stamps; what is not finite or not newer is left out. Angles do not wrap.
  void Add(const PanState& state);
  // Between two readings on the straight line, beyond the oldest and newest kept that one's. Nothing before the first.
  std::optional<double> At(Time time) const;

 private:
  std::deque<PanState> states_;
};

}  // namespace merlin
