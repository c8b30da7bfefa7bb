// A unit that turns the cameras about the vertical. Optional: MERLIN's cameras are fixed.
#pragma once

#include <optional>

#include "robot/hal/device_status.h"
#include "robot/types/time.h"

namespace merlin {

struct PanState {
  Time stamp{0};
  double angle_rad = 0.0;  // counter-clockwise seen from above, 0: straight ahead
};

class PanUnit {
 public:
  virtual ~PanUnit() = default;
  virtual void Send(double angle_rad) = 0;
  virtual std::optional<PanState> Poll() = 0;
  virtual DeviceStatus Status() const = 0;
};

}  // namespace merlin
