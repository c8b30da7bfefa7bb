// A colour camera.
#pragma once

#include <optional>

#include "robot/hal/device_status.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"

namespace merlin {

struct ColorCameraInfo {
  ColorCameraSheet sheet;
  Pose T_base_camera = Pose::Identity();  // optical frame
  double rate_hz = 0.0;
};

class ColorCamera {
 public:
  virtual ~ColorCamera() = default;
  virtual const ColorCameraInfo& Info() const = 0;
  // The oldest frame not yet handed out, if any; each once, in order of stamps.
  virtual std::optional<ColorFrame> Poll() = 0;
  virtual DeviceStatus Status() const = 0;
};

}  // namespace merlin
