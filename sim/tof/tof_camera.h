// The time-of-flight camera: what the pixels of a PMD chip measure of a scene. The lamp's light is modulated; the phase
// of the returning light tells how far it has travelled. A frame is four phase images (sub-frames) taken one after the
// other, so anything that moves meanwhile is measured at four positions. Each stage is a file of its own:
//
//   optics      where each sub-ray of a pixel looks, how bright the lamp is there
//   hits        what the sub-rays meet, at mid-exposure and again in each sub-frame
//   returns     further light: through panes, from mirrors, from retro-reflectors
//   multipath   light that reaches a pixel after one bounce
//   ambient     sun, sky and lamps
//   phasors     the sum of all these per pixel, as amplitude and phase
//   scatter     light that spreads within the lens
//   chip        electrons, noise, saturation, converter: the two taps of a pixel
//   decode      taps to range, amplitude, intensity and flags, less the factory calibration
//
// Frames: world (the room's), camera (optical: z forward, x right, y down). A range is measured along the ray.
// After Keller and Kolb, "Real-time simulation of time-of-flight sensors", Simulation Modelling Practice and Theory 17
// (2009), and Lambers, Hoberg, Kolb, "Simulation of time-of-flight sensors for evaluation of chip layout variants",
// IEEE Sensors Journal 15(7) (2015).
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

  // settings must be valid for the sheet. stamp: mid-exposure, in time since the camera was switched on. A pixel
  // without returning light is kInvalid, with range 0. The noise of a pixel depends only on (seed, index, pixel). The
  // bits are the same for any number of threads.
  DepthFrame Expose(const TofView& view, const DepthSettings& settings, Time stamp, std::uint64_t index) const;

  // The same frame without errors, and how much each effect changes it.
  TofTruth Truth(const TofView& view, const DepthSettings& settings, Time stamp) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin::sim
