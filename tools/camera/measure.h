// Takes frames with one simulated camera in one scene, and summarises them.
#pragma once

#include <atomic>
#include <cstdint>

#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "sim/tof/effects.h"
#include "sim/tof/truth.h"
#include "tools/camera/stage.h"
#include "tools/camera/statistics.h"

namespace merlin {

struct Shooting {
  DepthCameraSheet sheet;
  DepthCameraErrors errors;
  DepthSettings settings;
  sim::TofEffects effects;
  std::uint64_t seed = 1;
  int frames = 20;  // at the camera's highest rate; the first one right after it is switched on
  int threads = 1;  // any number gives the same bits
};

// Each range is unwrapped to the period nearest to its true range; then the wraps of the centre pixel's true range are
// subtracted. So a wall at 9.0 m reads about 1.505 m at 20 MHz, as the camera would say, and noise across a wrap does not
// become a jump. Invalid pixels count neither for ranges nor for the amplitude.
struct Measurement {
  RangeStatistics center, middle, whole;            // pixel (width / 2, height / 2); middle ninth of the image; all
  double valid_share = 0.0, saturated_share = 0.0;  // of all pixels of all frames
  double amplitude_mean = 0.0;                      // electrons; 0 without valid pixels
  double frame_ms = 0.0;                            // median wall time of a frame
  double true_center_m = 0.0;                       // not wrapped; 0: nothing there
  DepthFrame last;                                  // with its phase images
  sim::TofTruth truth;                              // of that frame
};

// Takes at least one frame. Stops early, with the frames it has, when interrupted becomes true.
Measurement Measure(const Shooting& shooting, const sim::TofView& view, const std::atomic<bool>& interrupted);

}  // namespace merlin
