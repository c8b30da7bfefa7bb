// Errors that a camera itself adds to every phase, and how much of them its factory calibration subtracts again.
#pragma once

#include <vector>

#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "robot/types/time.h"
#include "sim/tof/chip.h"

namespace merlin::sim {

// The peculiarities of every pixel of one specimen, drawn from (seed, pixel). Phase errors as lengths [m].
struct FixedPattern {
  FixedPattern(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects,
               std::uint64_t seed);
  std::vector<PixelTraits> traits;
  std::vector<float> range_m;  // what the pixel adds
  std::vector<float> known_m;  // how much of that the calibration subtracts
};

// Drift [m]: what the temperatures of camera and room add at time since_cold; how much of that the calibration
// subtracts.
struct Drift {
  double range_m = 0.0, known_m = 0.0;
};
Drift DriftAt(const DepthCameraErrors& errors, const TofEffects& effects, Time since_cold, double room_c);

// Phase error [rad] that harmonics make in the four-phase decoding: exactly, by its sums. About
// -(harmonic_3 - harmonic_5) sin(4 phase).
double WigglingError_rad(double phase_rad, const DepthCameraErrors& errors);

// Subtracts the wiggling from a decoded phase, all but a residual of errors.wiggling_residual_m rms. A table over the phase.
class WigglingCorrection {
 public:
  WigglingCorrection(const DepthCameraErrors& errors, double frequency_hz);
  double operator()(double phase_rad) const;  // what to subtract [rad], phase in [0, 2 pi]
  double Slope(double phase_rad) const;       // its derivative; any phase
  double frequency_hz() const { return frequency_hz_; }

 private:
  double frequency_hz_;
  std::vector<double> table_rad_;  // over [0, 2 pi), and once more the first
};

}  // namespace merlin::sim
