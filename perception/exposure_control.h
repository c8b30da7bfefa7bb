// Decides the depth camera's integration time, frame by frame. The long exposure is fixed, or follows the scene
// (perception/integration_time.h). Where it saturates pixels, every other frame is exposed for a shorter time, so that
// what is close is measured too: near and far surfaces need not fit one exposure.
//
//   long exposure     fixed or automatic; far surfaces
//   short exposure    at most a quarter of it, while the long one saturates pixels and a second longer; near surfaces
//
// Each frame carries its own settings, so frames that are still on their way when the exposure changes do no harm.
#pragma once

#include <optional>

#include "perception/integration_time.h"
#include "robot/types/depth_camera.h"

namespace merlin {

class ExposureControl {
 public:
  ExposureControl(const DepthCameraSheet& sheet, double rate_hz, const IntegrationConfig& config)
      : sheet_(sheet), rate_hz_(rate_hz), config_(config) {}

  // The settings for the next exposure, from the newest frame. The first frame's exposure is the long one.
  DepthSettings After(const DepthFrame& frame);

 private:
  bool Saturates(const DepthFrame& frame) const;
  void AdaptShort(const DepthFrame& frame);

  DepthCameraSheet sheet_;
  double rate_hz_;
  IntegrationConfig config_;
  std::optional<double> long_s_;
  std::optional<double> short_s_;  // none: every exposure is a long one
  Time short_until_{0};
  bool short_next_ = false;
};

}  // namespace merlin
