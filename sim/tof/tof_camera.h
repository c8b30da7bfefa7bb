// The time-of-flight camera: what the pixels of a PMD chip make of a scene. Sub-rays, sub-frames, phasors, taps, noise,
// decoding, calibration. After Keller and Kolb, "Real-time simulation of time-of-flight sensors", Simul. Model. Pract.
// Theory 17 (2009), and Lambers, Hoberg, Kolb, IEEE Sensors J. 15(7) (2015).
#pragma once

#include <cstdint>
#include <memory>

#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "sim/tof/effects.h"
#include "sim/tof/truth.h"
#include "sim/tof/view.h"

namespace merlin::sim {

class TofCamera {
 public:
  TofCamera(DepthCameraSheet sheet, DepthCameraErrors errors, TofEffects effects, std::uint64_t seed, int threads = 1);
  ~TofCamera();
  TofCamera(TofCamera&&) noexcept;

  // settings must be valid ones of the sheet. stamp: mid-exposure, since the camera was switched on. A pixel without a
  // return is kInvalid, its range 0. A pixel's noise depends on (seed, index, pixel) alone. Same bits for any number of
  // threads.
  DepthFrame Expose(const TofView& view, const DepthSettings& settings, Time stamp, std::uint64_t index) const;

  // What that frame would be without errors, and what each effect does to it.
  TofTruth Truth(const TofView& view, const DepthSettings& settings, Time stamp) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin::sim
