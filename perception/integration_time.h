// Adapts the depth camera's integration time to the scene. At a long time near walls saturate; at a short one far walls
// are lost in noise. perception/exposure_control.h uses it frame by frame. The rule is that of D. Wiedemann, M. Sauer,
// F. Driewer and K. Schilling, "Analysis and characterization of the PMD camera for application in mobile robotics",
// IFAC World Congress 2008: T_new = T_old (1 + dev), where dev is the relative deviation of the mean amplitude from a
// target.
#pragma once

#include "robot/base/config.h"
#include "robot/types/depth_camera.h"

namespace merlin {

// All values are guesses.
struct IntegrationConfig {
  bool automatic = false;          // no key of its own: sensors.depth.integration_us of a scenario says it
  double target_share = 0.2;       // [0.01, 0.9] target for the mean amplitude, as a share of that of a full well
  double dead_band = 0.1;          // [0, 0.5] a smaller |dev| changes nothing
  double step_max = 0.5;           // [0.05, 0.9] largest |dev| per frame; a higher value adapts faster, and overshoots
  double saturated_weight = 5.0;   // [1, 100] a saturated pixel counts as so many full wells; higher: fewer saturate
  double saturated_share = 0.005;  // [0, 1] a larger saturated share of the picture asks for short exposures, too
};

template <class Visitor>
void Visit(Visitor& v, IntegrationConfig& c) {
  v("target_share", c.target_share, {0.01, 0.9});
  v("dead_band", c.dead_band, {0.0, 0.5});
  v("step_max", c.step_max, {0.05, 0.9});
  v("saturated_weight", c.saturated_weight, {1.0, 100.0});
  v("saturated_share", c.saturated_share, {0.0, 1.0});
}

// Amplitude [e] of a pixel whose fuller tap is just full: the tap holds (1 + C) N / 2, and the amplitude is C N.
double FullAmplitude_e(const DepthCameraSheet& sheet, double frequency_hz);

// The integration time to begin with: a white wall (albedo 0.8) that faces the camera at 1 m just fills the well.
// Within the data sheet's range, and short enough for rate_hz.
double StartIntegration_s(const DepthCameraSheet& sheet, const DepthSettings& settings, double rate_hz);

// The settings for the next frame: those of this frame with a new integration time. It stays within the range of the
// data sheet and lets all sub-frames end within one period of rate_hz. It depends on this frame alone, so frames that
// arrive late with an older setting do no harm. A frame without usable pixels changes nothing.
DepthSettings Adapt(const DepthFrame& frame, const DepthCameraSheet& sheet, double rate_hz,
                    const IntegrationConfig& config);

}  // namespace merlin
