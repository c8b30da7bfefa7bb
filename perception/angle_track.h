// The angle of something that turns (pan unit, turntable) at any instant of the last second, interpolated between its
// readings.
#pragma once

#include <deque>
#include <optional>

#include "robot/types/measurements.h"

namespace merlin {

class AngleTrack {
 public:
  // Readings in the order of their stamps. One that is not finite or not newer is left out. Angles do not wrap.
  void Add(const PanState& state);
  // Linear between two readings; before the oldest and after the newest reading, that reading's angle. Nothing while
  // there is no reading.
  std::optional<double> At(Time time) const;

 private:
  std::deque<PanState> states_;
};

}  // namespace merlin
