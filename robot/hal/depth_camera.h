// A time-of-flight camera.
#pragma once

#include <optional>

#include "robot/types/depth_camera.h"
#include "robot/types/device_status.h"
#include "robot/types/se3.h"

namespace merlin {

struct DepthCameraInfo {
  DepthCameraSheet sheet;                 // model, intrinsics, valid settings
  Pose T_base_camera = Pose::Identity();  // optical frame
  double rate_hz = 0.0;
};

class DepthCamera {
 public:
  virtual ~DepthCamera() = default;
  virtual const DepthCameraInfo& Info() const = 0;
  // Applies from the next exposure on. Throws InputError for settings outside the sheet's.
  virtual void Configure(const DepthSettings& settings) = 0;
  // The oldest frame not yet handed out, if any; each once, in order of stamps.
  virtual std::optional<DepthFrame> Poll() = 0;
  virtual DeviceStatus Status() const = 0;
};

}  // namespace merlin
