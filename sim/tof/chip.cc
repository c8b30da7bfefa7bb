#include "sim/tof/chip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin::sim {
namespace {

// Above this mean, shot and read noise are drawn as one Gaussian, which takes half as many random numbers.
constexpr double kGaussianAbove_e = 50.0;

constexpr double kHotFullWells = 10.0;

}  // namespace

Chip::Chip(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects)
    : effects_(effects),
      full_well_e_(sheet.full_well_e),
      read_variance_e2_(sheet.read_noise_e * sheet.read_noise_e),
      dark_e_per_s_(errors.dark_e_per_us * 1e6),
      response_cubic_(errors.response_cubic),
      sbi_onset_e_(errors.sbi_onset * sheet.full_well_e),
      sbi_max_e_(errors.sbi_max * sheet.full_well_e),
      sbi_noise_(errors.sbi_noise),
      counts_max_(std::exp2(std::floor(errors.adc_bits)) - 1.0),
      black_dn_(errors.adc_black_dn),
      has_sbi_(sheet.sbi) {
  quantum_e_ = full_well_e_ / (counts_max_ - black_dn_);
}

double Chip::Noisy(double mean_e, double extra_variance_e2, Random& random) const {
  if (mean_e + extra_variance_e2 > kGaussianAbove_e)
    return mean_e + std::sqrt(std::max(0.0, mean_e) + extra_variance_e2 + read_variance_e2_) * random.Normal();
  return random.Poisson(std::max(0.0, mean_e)) + std::min(0.0, mean_e) +
         std::sqrt(extra_variance_e2 + read_variance_e2_) * random.Normal();
}

double Chip::Converted(double tap_e) const {
  const double counts = std::clamp(std::round(tap_e / quantum_e_ + black_dn_), 0.0, counts_max_);
  return (counts - black_dn_) * quantum_e_;
}

Taps Chip::Expose(const PixelLight& light, const PixelTraits& pixel, double integration_s, Random& random) const {
  double total_e = pixel.dead ? 0.0 : light.total_e;
  const double correlation_e = pixel.dead ? 0.0 : light.correlation_e;
  if (effects_.noise) total_e += dark_e_per_s_ * integration_s;
  if (pixel.hot) total_e += kHotFullWells * full_well_e_;

  Taps taps{.a_e = 0.5 * (total_e + correlation_e) * (1.0 + pixel.gain) + pixel.offset_e,
            .b_e = 0.5 * (total_e - correlation_e) * (1.0 - pixel.gain) + pixel.offset_e};
  if (effects_.sbi && has_sbi_ && !pixel.hot)  // charge that leaks into a hot pixel is not light common to both taps
    taps.suppressed_e = std::clamp(std::min(taps.a_e, taps.b_e) - sbi_onset_e_, 0.0, sbi_max_e_);
  if (effects_.noise) taps.suppression_variance_e2 = sbi_noise_ * taps.suppressed_e;
  for (double* tap : {&taps.a_e, &taps.b_e}) {
    *tap -= taps.suppressed_e;
    if (effects_.saturation && *tap > full_well_e_) taps.saturated = true;
    if (effects_.intensity) {
      const double filling = std::min(1.0, *tap / full_well_e_);
      *tap *= 1.0 - response_cubic_ * filling * filling;
    }
    if (effects_.saturation) *tap = std::min(*tap, full_well_e_);
    if (effects_.noise) *tap = Noisy(*tap, taps.suppression_variance_e2, random);
    if (effects_.adc) *tap = Converted(*tap);
  }
  return taps;
}

double Chip::DifferenceVariance_e2(const Taps& taps, double integration_s) const {
  double variance_e2 = 0.0;
  if (effects_.noise)
    variance_e2 += taps.a_e + taps.b_e + dark_e_per_s_ * integration_s +
                   2.0 * (read_variance_e2_ + sbi_noise_ * taps.suppressed_e);
  if (effects_.adc) variance_e2 += 2.0 * quantum_e_ * quantum_e_ / 12.0;
  return variance_e2;
}

PhaseReading DecodePhase(const Taps taps[4]) {
  const auto D = [taps](int k) { return taps[k].a_e - taps[k].b_e; };
  const double I = D(0) - D(2);
  const double Q = D(3) - D(1);
  double phase_rad = std::atan2(Q, I);
  if (phase_rad < 0.0) phase_rad += 2.0 * std::numbers::pi;
  if (phase_rad >= 2.0 * std::numbers::pi) phase_rad = 0.0;  // -tiny + 2 pi
  return {.phase_rad = phase_rad, .amplitude_e = std::sqrt(I * I + Q * Q) / 2.0};
}

bool Inconsistent(const Taps taps[4], double amplitude_e, double read_noise_e) {
  const auto D = [taps](int k) { return taps[k].a_e - taps[k].b_e; };
  double collected_e = 0.0, suppression_e2 = 0.0;  // mean of the taps' sums and variances
  for (int k = 0; k < 4; ++k) {
    collected_e += 0.25 * (taps[k].a_e + taps[k].b_e);
    suppression_e2 += 0.25 * 2.0 * taps[k].suppression_variance_e2;
  }
  const double residual_e = std::max(std::abs(D(0) + D(2)), std::abs(D(1) + D(3)));
  const double sigma_e =
      std::sqrt(2.0 * (std::max(0.0, collected_e) + suppression_e2 + 2.0 * read_noise_e * read_noise_e));
  return residual_e > 0.4 * 2.0 * amplitude_e && residual_e > 4.0 * sigma_e;
}

double RangeSigma_m(double signal_e, double background_e, double contrast, double read_noise_e, double frequency_hz) {
  return kSpeedOfLight_m_s / (4.0 * std::numbers::sqrt2 * std::numbers::pi * frequency_hz) *
         std::sqrt(signal_e + background_e + 2.0 * read_noise_e * read_noise_e) / (contrast * signal_e);
}

}  // namespace merlin::sim
