// Phase errors that the camera itself causes, and the part of them that its factory calibration subtracts again.
#pragma once

#include <vector>

#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "robot/types/time.h"
#include "sim/tof/chip.h"

namespace merlin::sim {

// The fixed pattern of one specimen, drawn from (seed, pixel). Phase errors as lengths [m].
struct FixedPattern {
  FixedPattern(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects,
               std::uint64_t seed);
  std::vector<PixelTraits> traits;
  std::vector<float> range_m;  // error of the pixel
  std::vector<float> known_m;  // part of it that the calibration subtracts
};

// Drift [m] that the temperatures of camera and room cause at time since_cold, and the part of it that the calibration
// subtracts.
struct Drift {
  double range_m = 0.0, known_m = 0.0;
};
Drift DriftAt(const DepthCameraErrors& errors, const TofEffects& effects, Time since_cold, double room_c);

// Phase error [rad] that harmonics cause in the four-phase decoding, computed exactly from its sums. It is about
// -(harmonic_3 - harmonic_5) sin(4 phase).
double WigglingError_rad(double phase_rad, const DepthCameraErrors& errors);

// Subtracts the wiggling from a decoded phase, all but a residual of errors.wiggling_residual_m rms. A table over the
// phase.
class WigglingCorrection {
 public:
  WigglingCorrection(const DepthCameraErrors& errors, double frequency_hz);
  double operator()(double phase_rad) const;  // what to subtract [rad], phase in [0, 2 pi]
  double Slope(double phase_rad) const;       // its derivative; any phase
  double frequency_hz() const { return frequency_hz_; }

 private:
  double frequency_hz_;
  std::vector<double> table_rad_;  // over [0, 2 pi), with the first value repeated at the end
};

}  // namespace merlin::sim
