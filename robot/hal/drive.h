// Motor and steering of a car.
#pragma once

#include <optional>

#include "robot/types/device_status.h"
#include "robot/types/measurements.h"

namespace merlin {

class Drive {
 public:
  virtual ~Drive() = default;
  // Replaces the command in force; it ends after command.valid_for. Speed and steering beyond the car's limits are
  // clamped to them; a number that is not finite expires at once. From expiry the motor is braked within 200 ms, and
  // the car stands (|v| < 0.01 m/s) within 0.2 s + v / (2 m/s^2).
  virtual void Send(const DriveCommand& command) = 0;
  // The oldest state not yet handed out, if any; each once, in order of stamps.
  virtual std::optional<DriveState> Poll() = 0;
  virtual DeviceStatus Status() const = 0;
};

}  // namespace merlin
