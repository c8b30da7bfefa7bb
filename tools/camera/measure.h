// Frames of one camera before one stage, and what they say together.
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
  int frames = 20;  // at the model's highest rate, the first one as the camera is switched on
  int threads = 1;  // same bits for any number
};

// Ranges are unwrapped about the truth, less the wraps of the centre's true range: a wall at 9.0 m reads about 1.505 m
// at 20 MHz, and noise about a wrap stays noise. Invalid pixels are left out of ranges and amplitude.
struct Measurement {
  RangeStatistics center, middle, whole;            // the pixel at (width / 2, height / 2); the middle ninth; all
  double valid_share = 0.0, saturated_share = 0.0;  // of all pixels of all frames
  double amplitude_mean = 0.0;                      // electrons; 0 without valid pixels
  double frame_ms = 0.0;                            // median wall time of a frame
  double true_center_m = 0.0;                       // not wrapped; 0: nothing there
  DepthFrame last;                                  // with its phase images
  sim::TofTruth truth;                              // of that frame
};

// Stops early, with the frames it has, when interrupted becomes true after one or more.
Measurement Measure(const Shooting& shooting, const sim::TofView& view, const std::atomic<bool>& interrupted);

}  // namespace merlin
