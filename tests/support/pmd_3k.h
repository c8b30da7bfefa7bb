// A 64x48 PMD camera for tests. Its numbers are round, or those of the predictions that tests compare with.
#pragma once

#include "robot/types/depth_camera.h"

namespace merlin {

inline DepthCameraSheet Pmd3k() {
  DepthCameraSheet sheet;
  sheet.camera = {.width = 64, .height = 48, .fx_px = 87.9, .fy_px = 89.6, .cx_px = 31.5, .cy_px = 23.5};
  sheet.signal_e_m2_per_us = 2000.0;
  sheet.contrast_at_20mhz = 0.45;
  sheet.contrast_corner_hz = 30e6;
  sheet.read_noise_e = 200.0;
  sheet.full_well_e = 1.5e6;
  sheet.sbi = true;
  sheet.frequencies_hz = {20e6, 30e6};
  return sheet;
}

// The same camera with another image and other limits of its exposure.
inline DepthCameraSheet ExposingPmd3k(const CameraModel& camera) {
  DepthCameraSheet sheet = Pmd3k();
  sheet.camera = camera;
  sheet.readout_s = 1e-3;
  sheet.low_signal_amplitude_e = 600.0;
  sheet.integration_min_s = 100e-6;
  sheet.integration_max_s = 5000e-6;
  return sheet;
}

}  // namespace merlin
