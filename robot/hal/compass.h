// An attitude sensor with a magnetometer. The driver turns headings into yaw: yaw = north_yaw - heading.
#pragma once

#include <optional>

#include "robot/types/device_status.h"
#include "robot/types/measurements.h"

namespace merlin {

class Compass {
 public:
  virtual ~Compass() = default;
  // The oldest reading not yet handed out, if any; each once, in order of stamps.
  virtual std::optional<CompassReading> Poll() = 0;
  virtual DeviceStatus Status() const = 0;
};

}  // namespace merlin
