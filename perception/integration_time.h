// Adapts the depth camera's integration time to the scene: near walls saturate at a long one, far ones drown in noise
// at a short one. After Wiedemann, Sauer, Driewer, Schilling, "Analysis and characterization of the PMD camera for
// application in mobile robotics", IFAC World Congress 2008: T_new = T_old (1 + dev), dev the mean amplitude's relative
// deviation from a target.
#pragma once

#include "robot/base/config.h"
#include "robot/types/depth_camera.h"

namespace merlin {

// Guesses, all but the rule itself.
struct IntegrationConfig {
  bool adapt = false;
  double target_share = 0.2;  // [0.01, 0.9] wanted mean amplitude, in that of a just full well: bright spots need room
  double dead_band = 0.1;     // [0, 0.5] a smaller |dev| changes nothing
  double step_max = 0.5;      // [0.05, 0.9] largest |dev| a frame; higher is faster, and overshoots
  double saturated_weight = 5.0;  // [1, 100] a saturated pixel counts as that many full wells; higher tolerates fewer
};

template <class Visitor>
void Visit(Visitor& v, IntegrationConfig& c) {
  v("adapt", c.adapt);
  v("target_share", c.target_share, {0.01, 0.9});
  v("dead_band", c.dead_band, {0.0, 0.5});
  v("step_max", c.step_max, {0.05, 0.9});
  v("saturated_weight", c.saturated_weight, {1.0, 100.0});
}

// The settings for the next frame: those of this frame, but for the integration time. It stays within the sheet's valid
// range and lets all sub-frames end within a period of rate_hz. It follows from this frame alone, so frames still on
// their way with an older setting do no harm. A frame without usable pixels changes nothing.
DepthSettings Adapt(const DepthFrame& frame, const DepthCameraSheet& sheet, double rate_hz,
                    const IntegrationConfig& config);

}  // namespace merlin
