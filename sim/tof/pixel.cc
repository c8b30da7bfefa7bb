// The two-tap lock-in pixel: R. Lange, "3D time-of-flight distance measurement with custom solid-state image sensors in
// CMOS/CCD-technology", PhD thesis, Siegen 2000; the demodulation is its four-phase algorithm.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/tof/tof_camera.h"

namespace merlin::sim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNearest_m = 1e-3;  // nothing is nearer to the pixel than its lens: keeps 1 / d^2 finite

// Above this mean, shot and read noise are one Gaussian: half the random numbers.
constexpr double kGaussianAbove_e = 50.0;

double NoisyTap(double mean_e, double read_noise_e, Random& random) {
  if (mean_e > kGaussianAbove_e) return mean_e + std::sqrt(mean_e + read_noise_e * read_noise_e) * random.Normal();
  return random.Poisson(mean_e) + read_noise_e * random.Normal();
}

double ClippedTap(double tap_e, double full_well_e, bool& saturated) {
  saturated |= tap_e > full_well_e;
  return std::min(tap_e, full_well_e);
}

}  // namespace

PixelTaps ExposePixel(const PixelScene& scene, const DepthCameraSheet& sheet, const DepthSettings& settings,
                      const TofEffects& effects, Random& random) {
  PixelTaps taps{};
  if (scene.range_m >= 0.0) {
    // A point-like lamp at the lens and a Lambertian surface: N_s = K rho cos(theta) T / d^2.
    const double range_m = std::max(scene.range_m, kNearest_m);
    const double signal_e = sheet.signal_e_m2_per_us * scene.albedo * scene.cos_incidence *
                            (settings.integration_s * 1e6) / (range_m * range_m);
    // m_k = C N_s cos(phi + k pi / 2).
    const double phi = 4.0 * kPi * settings.frequency_hz * scene.range_m / kSpeedOfLight_m_s;
    const double modulated_e = sheet.Contrast(settings.frequency_hz) * signal_e;
    const double in_phase_e = modulated_e * std::cos(phi), quadrature_e = modulated_e * std::sin(phi);
    const double m[4] = {in_phase_e, -quadrature_e, -in_phase_e, quadrature_e};
    for (int k = 0; k < 4; ++k) {
      taps.a[k] = 0.5 * (signal_e + m[k]);
      taps.b[k] = 0.5 * (signal_e - m[k]);
    }
  }
  for (int k = 0; k < 4; ++k) {
    for (double* tap : {&taps.a[k], &taps.b[k]}) {
      if (effects.noise) *tap = NoisyTap(*tap, sheet.read_noise_e, random);
      if (effects.saturation) *tap = ClippedTap(*tap, sheet.full_well_e, taps.saturated);
    }
  }
  return taps;
}

PixelReading DecodePixel(const PixelTaps& taps, double frequency_hz) {
  const auto D = [&taps](int k) { return taps.a[k] - taps.b[k]; };
  const double I = D(0) - D(2);
  const double Q = D(3) - D(1);
  double phase = std::atan2(Q, I);
  if (phase < 0.0) phase += 2.0 * kPi;
  const double range_max_m = UnambiguousRange_m(frequency_hz);
  float range_m = static_cast<float>(phase / (2.0 * kPi) * range_max_m);
  // A phase just below 2 pi may round up to the wrap itself.
  if (range_m >= range_max_m) range_m = std::nextafter(static_cast<float>(range_max_m), 0.0f);

  double sum_e = 0.0;
  for (int k = 0; k < 4; ++k) sum_e += taps.a[k] + taps.b[k];
  return {.range_m = range_m,
          .amplitude = static_cast<float>(std::sqrt(I * I + Q * Q) / 2.0),
          .intensity = static_cast<float>(sum_e / 8.0)};
}

double RangeSigma_m(double signal_e, double contrast, double read_noise_e, double frequency_hz) {
  return kSpeedOfLight_m_s / (4.0 * std::numbers::sqrt2 * kPi * frequency_hz) *
         std::sqrt(signal_e + 2.0 * read_noise_e * read_noise_e) / (contrast * signal_e);
}

}  // namespace merlin::sim
