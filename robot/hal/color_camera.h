// A colour camera.
#pragma once

#include <optional>

#include "robot/types/color_camera.h"
#include "robot/types/device_status.h"
#include "robot/types/se3.h"

namespace merlin {

struct ColorCameraInfo {
  ColorCameraSheet sheet;                 // model, intrinsics with distortion, valid settings
  Pose T_base_camera = Pose::Identity();  // optical frame
  double rate_hz = 0.0;
};

class ColorCamera {
 public:
  virtual ~ColorCamera() = default;
  virtual const ColorCameraInfo& Info() const = 0;
  // Applies from the next exposure on; with auto_exposure the camera starts anew from these. Throws InputError for
  // settings outside the sheet's.
  virtual void Configure(const ColorSettings& settings) = 0;
  // The oldest frame not yet handed out, if any; each once, in order of stamps.
  virtual std::optional<ColorFrame> Poll() = 0;
  virtual DeviceStatus Status() const = 0;
};

}  // namespace merlin
