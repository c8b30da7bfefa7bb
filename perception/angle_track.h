// The angle of something that turns (pan unit, turntable) at any instant of the last second, interpolated between its
// readings. A servo moves in steps, and a frame is often taken just as it sets off. There a straight line between two
// readings 20 ms apart is up to 7 mrad wrong. A monotone cubic (F. Fritsch and R. Carlson, "Monotone piecewise cubic
// interpolation", SIAM J. Numer. Anal. 17, 1980, with the slopes of F. Fritsch and J. Butland, 1984) sets off slowly from
// rest, does not overshoot, and follows an even turn exactly.
#pragma once

#include <deque>
#include <optional>

#include "robot/types/measurements.h"

namespace merlin {

class AngleTrack {
 public:
  // Readings in the order of their stamps. One that is not finite or not newer is left out. Angles do not wrap.
  void Add(const PanState& state);
  // Interpolated between two readings; before the oldest and after the newest reading, that reading's angle. Nothing while
  // there is no reading.
  std::optional<double> At(Time time) const;

 private:
  std::deque<PanState> states_;
};

}  // namespace merlin
