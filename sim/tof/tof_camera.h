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

// "all", "ideal", or names with commas ("noise,saturation"; "-noise" takes one out of all). Throws InputError naming the nearest.
TofEffects ParseTofEffects(const std::string& text);

// What one pixel looks at.
struct PixelScene {
  double range_m = -1.0;     // negative: nothing
  double cos_incidence = 0;  // in [0, 1]
  double albedo = 0;         // near infrared, diffuse
};

// Expected and then noisy taps [e] of the four sub-frames of a pixel.
struct PixelTaps {
  double a[4];
  double b[4];
  bool saturated = false;
};

// Steps 2, 6, 7, 8, 9 of the forward model for one pixel.
PixelTaps ExposePixel(const PixelScene& scene, const DepthCameraSheet& sheet, const DepthSettings& settings,
                      const TofEffects& effects, Random& random);

struct PixelReading {
  float range_m = 0, amplitude = 0, intensity = 0;
};
// I = D0 - D2, Q = D3 - D1; phase, amplitude, intensity.
PixelReading DecodePixel(const PixelTaps& taps, double frequency_hz);

// The standard deviation of range [m] for N_s signal electrons of both taps in one sub-frame (small-error law of this
// two-tap, four-phase estimator; Lange 2000).
double RangeSigma_m(double signal_e, double contrast, double read_noise_e, double frequency_hz);

class TofCamera {
 public:
  TofCamera(DepthCameraSheet sheet, TofEffects effects, std::uint64_t seed);
  // albedo[geom id]. T_world_camera: optical frame at mid-exposure.
  DepthFrame Expose(const RayScene& scene, std::span<const double> albedo, const Pose& T_world_camera,
                    const DepthSettings& settings, Time stamp, std::uint64_t index) const;

 private:
  DepthCameraSheet sheet_;
  TofEffects effects_;
  std::uint64_t seed_;
  std::vector<Eigen::Vector3f> rays_;  // optical frame, one a pixel
};

}  // namespace merlin::sim
