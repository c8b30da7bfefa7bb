// The time-of-flight camera: what a pixel of a PMD chip makes of light. Four phase images, taps, noise, decoding.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "robot/types/depth_camera.h"
#include "sim/materials.h"
#include "sim/random.h"
#include "sim/ray_scene.h"

namespace merlin::sim {

// Which errors the camera makes. Range wrap is none of them: it is the measuring principle.
struct TofEffects {
  bool noise = true;       // shot and read noise of each tap
  bool saturation = true;  // a tap clips at the full well
};

// "all", "ideal" (none), or names with commas, read from left to right: "noise,saturation" is these two, "-noise" all
// but one. Throws InputError naming the nearest.
TofEffects ParseTofEffects(const std::string& text);

// What one pixel looks at.
struct PixelScene {
  double range_m = -1.0;     // negative: nothing, its taps hold read noise alone
  double cos_incidence = 0;  // in [0, 1]
  double albedo = 0;         // near infrared, diffuse
};

// Expected and then noisy taps [e] of the four sub-frames of a pixel.
struct PixelTaps {
  double a[4];
  double b[4];
  bool saturated = false;
};

// Signal N_s = K rho cos(theta) T / d^2 (point-like lamp at the lens, Lambertian surface; Lambers, Hoberg, Kolb, IEEE
// Sensors J. 15(7), 2015), correlation, taps (N_s +- C N_s cos(phi + k pi / 2)) / 2, shot and read noise, full well.
PixelTaps ExposePixel(const PixelScene& scene, const DepthCameraSheet& sheet, const DepthSettings& settings,
                      const TofEffects& effects, Random& random);

struct PixelReading {
  float range_m = 0, amplitude = 0, intensity = 0;
};
// D_k = a_k - b_k, I = D_0 - D_2, Q = D_3 - D_1: range = c / (4 pi f) atan2(Q, I), in [0, c / 2f), amplitude =
// sqrt(I^2 + Q^2) / 2 [e], intensity = sum of the eight taps / 8 [e].
PixelReading DecodePixel(const PixelTaps& taps, double frequency_hz);

// The standard deviation of range [m] for N_s signal electrons of both taps in one sub-frame (small-error law of this
// two-tap, four-phase estimator; Lange 2000).
double RangeSigma_m(double signal_e, double contrast, double read_noise_e, double frequency_hz);

class TofCamera {
 public:
  TofCamera(DepthCameraSheet sheet, TofEffects effects, std::uint64_t seed);
  // albedo[geom id]. T_world_camera: optical frame at mid-exposure. A pixel without a return is kInvalid, its range 0.
  // A pixel's noise depends on (seed, index, pixel) alone, not on what the others see.
  DepthFrame Expose(const RayScene& scene, std::span<const double> albedo, const Pose& T_world_camera,
                    const DepthSettings& settings, Time stamp, std::uint64_t index) const;

 private:
  DepthCameraSheet sheet_;
  TofEffects effects_;
  std::uint64_t seed_;
  std::vector<Eigen::Vector3f> rays_;  // optical frame, one a pixel
};

}  // namespace merlin::sim
