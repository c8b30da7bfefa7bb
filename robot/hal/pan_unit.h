// Something that turns about the vertical: the servo under the cameras (0 to 180 deg at its horn, 90 ahead: here -pi/2
// to pi/2, 0 ahead), or a turntable that turns the whole car, without end. Optional: MERLIN's cameras are fixed.
#pragma once

#include <optional>

#include "robot/types/device_status.h"
#include "robot/types/measurements.h"

namespace merlin {

class PanUnit {
 public:
  virtual ~PanUnit() = default;
  // Turns to this angle, clamped to its range, at its own speed. The command does not expire. An angle that is not
  // finite is ignored.
  virtual void Send(double angle_rad) = 0;
  // The oldest state not yet handed out, if any; each once, in order of stamps.
  virtual std::optional<PanState> Poll() = 0;
  virtual DeviceStatus Status() const = 0;
};

}  // namespace merlin
