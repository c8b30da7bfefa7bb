// Adapts the depth camera's integration time to the scene. At a long time near walls saturate; at a short one far walls
// are lost in noise. The rule is that of D. Wiedemann, M. Sauer, F. Driewer and K. Schilling, "Analysis and
// characterization of the PMD camera for application in mobile robotics", IFAC World Congress 2008: T_new = T_old (1 +
// dev), where dev is the relative deviation of the mean amplitude from a target.
#pragma once

#include "robot/base/config.h"
#include "robot/types/depth_camera.h"

namespace merlin {

// All values are guesses.
struct IntegrationConfig {
  bool adapt = false;
  double target_share = 0.2;      // [0.01, 0.9] target for the mean amplitude, as a share of that of a full well
  double dead_band = 0.1;         // [0, 0.5] a smaller |dev| changes nothing
  double step_max = 0.5;          // [0.05, 0.9] largest |dev| per frame; a higher value adapts faster, and overshoots
  double saturated_weight = 5.0;  // [1, 100] a saturated pixel counts as so many full wells; higher: fewer saturate
};

template <class Visitor>
void Visit(Visitor& v, IntegrationConfig& c) {
  v("adapt", c.adapt);
  v("target_share", c.target_share, {0.01, 0.9});
  v("dead_band", c.dead_band, {0.0, 0.5});
  v("step_max", c.step_max, {0.05, 0.9});
  v("saturated_weight", c.saturated_weight, {1.0, 100.0});
}

// The settings for the next frame: those of this frame with a new integration time. It stays within the range of the
// data sheet and lets all sub-frames end within one period of rate_hz. It depends on this frame alone, so frames that
// arrive late with an older setting do no harm. A frame without usable pixels changes nothing.
DepthSettings Adapt(const DepthFrame& frame, const DepthCameraSheet& sheet, double rate_hz,
                    const IntegrationConfig& config);

}  // namespace merlin
