#include "sim/tof/calibration.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace merlin::sim {
namespace {

constexpr int kTableSize = 1024;
constexpr std::uint16_t kPatternPurpose = 1;  // of robot/base/random.h; not the stream of any frame

// A quadratic over the image, x and y in [-1, 1], with a largest value of 1 and a mean of about 0.
double Quadratic(double x, double y) { return 0.75 * (x * x + y * y - 2.0 / 3.0) + 0.25 * x * y; }

}  // namespace

FixedPattern::FixedPattern(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects,
                           std::uint64_t seed) {
  const int width = sheet.camera.width, height = sheet.camera.height;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      Random random(seed, Sensor::kDepth, 0, static_cast<std::uint32_t>(traits.size()), kPatternPurpose);
      const double white = random.Normal(), residual = random.Normal(), gain = random.Normal(),
                   offset = random.Normal();
      const double fate = random.Uniform();
      PixelTraits pixel;
      double range = 0.0, known = 0.0;
      if (effects.fixed_pattern) {
        pixel.gain = static_cast<float>(errors.tap_gain * gain);
        pixel.offset_e = static_cast<float>(errors.tap_offset_e * offset);
        range = errors.pattern_white_m * white +
                errors.pattern_smooth_m * Quadratic((2.0 * u + 1.0) / width - 1.0, (2.0 * v + 1.0) / height - 1.0);
        if (effects.calibrated) known = range - errors.pattern_residual_m * residual;
      }
      if (effects.dead_pixels) {
        pixel.dead = fate < errors.dead_share;
        pixel.hot = fate > 1.0 - errors.hot_share;
      }
      traits.push_back(pixel);
      range_m.push_back(static_cast<float>(range));
      known_m.push_back(static_cast<float>(known));
    }
  }
}

Drift DriftAt(const DepthCameraErrors& errors, const TofEffects& effects, Time since_cold, double room_c) {
  if (!effects.temperature) return {};
  const double room_m = errors.ambient_m_per_k * (room_c - 25.0);
  if (effects.calibrated) return {errors.warmup_m + room_m, errors.warmup_m};
  return {errors.warmup_m * (1.0 - std::exp(-Seconds(since_cold) / errors.warmup_time_s)) + room_m, 0.0};
}

double WigglingError_rad(double phase_rad, const DepthCameraErrors& errors) {
  // D_k = Re(z i^k + a3 z^3 i^(3k) + a5 z^5 i^(5k)) with z = e^(j phase): I = 2 Re(...), Q = 2 Im(z - a3 z^3 + a5 z^5).
  const std::complex<double> z = std::polar(1.0, phase_rad), z3 = z * z * z, z5 = z3 * z * z;
  const double in_phase = z.real() + errors.harmonic_3 * z3.real() + errors.harmonic_5 * z5.real();
  const double quadrature = z.imag() - errors.harmonic_3 * z3.imag() + errors.harmonic_5 * z5.imag();
  return std::remainder(std::atan2(quadrature, in_phase) - phase_rad, 2.0 * std::numbers::pi);
}

WigglingCorrection::WigglingCorrection(const DepthCameraErrors& errors, double frequency_hz)
    : frequency_hz_(frequency_hz) {
  // A sinusoid of this amplitude has the rms of the residual.
  const double peak_rad = std::abs(errors.harmonic_3 - errors.harmonic_5);
  const double residual_rad =
      errors.wiggling_residual_m * std::numbers::sqrt2 * 4.0 * std::numbers::pi * frequency_hz / kSpeedOfLight_m_s;
  const double taken_off = peak_rad > residual_rad ? 1.0 - residual_rad / peak_rad : 0.0;
  for (int i = 0; i <= kTableSize; ++i) {
    const double decoded_rad = 2.0 * std::numbers::pi * i / kTableSize;
    double phase_rad = decoded_rad;  // fixed-point iteration: the slope of the error is about 4 (a3 - a5), below 1
    for (int step = 0; step < 30; ++step) phase_rad = decoded_rad - WigglingError_rad(phase_rad, errors);
    table_rad_.push_back(taken_off * WigglingError_rad(phase_rad, errors));
  }
}

double WigglingCorrection::operator()(double phase_rad) const {
  const double at = phase_rad / (2.0 * std::numbers::pi) * kTableSize;
  const int i = std::clamp(static_cast<int>(at), 0, kTableSize - 1);
  const double share = at - i;
  return (1.0 - share) * table_rad_[static_cast<std::size_t>(i)] + share * table_rad_[static_cast<std::size_t>(i) + 1];
}

double WigglingCorrection::Slope(double phase_rad) const {
  constexpr double kStep_rad = 2.0 * std::numbers::pi / kTableSize;
  const double middle_rad = phase_rad - 2.0 * std::numbers::pi * std::floor(phase_rad / (2.0 * std::numbers::pi));
  const double low_rad = std::max(0.0, middle_rad - kStep_rad),
               high_rad = std::min(2.0 * std::numbers::pi, middle_rad + kStep_rad);
  return ((*this)(high_rad) - (*this)(low_rad)) / (high_rad - low_rad);
}

}  // namespace merlin::sim
