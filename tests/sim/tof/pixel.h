// Formulas for one pixel of a time-of-flight camera, its light, taps and readings, for tests of the chip.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "robot/base/random.h"
#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "sim/tof/chip.h"
#include "tests/support/pmd_3k.h"

namespace merlin::sim {

constexpr double kPeriod_m = 299792458.0 / 40e6;  // at 20 MHz

// A camera of 160x120 pixels, which cannot suppress background light.
inline DepthCameraSheet Pmd19k() {
  DepthCameraSheet sheet = Pmd3k();
  sheet.camera.width = 160, sheet.camera.height = 120;
  sheet.signal_e_m2_per_us = 330.0, sheet.read_noise_e = 100.0, sheet.full_well_e = 3e5;
  sheet.sbi = false;
  return sheet;
}

// A camera of 200x200 pixels.
inline DepthCameraSheet CamCube() {
  DepthCameraSheet sheet = Pmd3k();
  sheet.camera.width = sheet.camera.height = 200;
  sheet.signal_e_m2_per_us = 650.0, sheet.read_noise_e = 100.0, sheet.full_well_e = 4e5;
  return sheet;
}

// No effects except those in `on`.
template <class... Effect>
TofEffects Only(Effect... on) {
  TofEffects effects = kIdealTof;
  ((effects.*on = true), ...);
  return effects;
}

// Light of a pixel in a sub-frame: signal and background of both taps together, contrast, phase.
struct Light {
  double signal_e = 0.0, phase_rad = 0.0;
  double background_e = 0.0, contrast = 0.45;
  PixelLight At(int k) const {
    return {signal_e + background_e, contrast * signal_e * std::cos(phase_rad + k * std::numbers::pi / 2.0)};
  }
};

inline double PhaseOf(double range_m) { return 2.0 * std::numbers::pi * range_m / kPeriod_m; }
inline double RangeOf(double phase_rad) { return kPeriod_m * phase_rad / (2.0 * std::numbers::pi); }

// A facing wall: K rho T / d^2.
inline Light WallLight(const DepthCameraSheet& sheet, double albedo, double integration_s, double range_m) {
  return {.signal_e = sheet.signal_e_m2_per_us * albedo * integration_s * 1e6 / (range_m * range_m),
          .phase_rad = PhaseOf(range_m)};
}

using FourTaps = std::array<Taps, 4>;

inline FourTaps ExposeFour(const Chip& chip, const Light& light, std::uint64_t frame = 0,
                           const PixelTraits& traits = {}, double integration_s = 1e-3) {
  Random random(1, Sensor::kDepth, frame);
  FourTaps taps;
  for (int k = 0; k < 4; ++k)
    taps[static_cast<std::size_t>(k)] = chip.Expose(light.At(k), traits, integration_s, random);
  return taps;
}

// Phase difference, wrapped to half a turn at most.
inline double PhaseError_rad(double phase_rad, double true_rad) {
  return std::remainder(phase_rad - true_rad, 2.0 * std::numbers::pi);
}

}  // namespace merlin::sim
