#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/sim/tof/pixel.h"

namespace merlin::sim {
namespace {

const TofEffects kNoise = Only(&TofEffects::noise);

// The small-error law: c / (4 sqrt(2) pi f) sqrt(N_s + N_b + 2 r^2) / (C N_s).
double Law_m(double signal_e, double background_e, double contrast, double read_e, double frequency_hz = 20e6) {
  return 299792458.0 / (4.0 * std::sqrt(2.0) * std::numbers::pi * frequency_hz) *
         std::sqrt(signal_e + background_e + 2.0 * read_e * read_e) / (contrast * signal_e);
}

// Range errors [m] at 20 MHz, wrapped to half a period at most.
std::vector<double> RangeErrors(const Chip& chip, const Light& light, int n = 20000, double integration_s = 1e-3) {
  std::vector<double> errors;
  for (int i = 0; i < n; ++i) {
    const FourTaps taps = ExposeFour(chip, light, static_cast<std::uint64_t>(i), {}, integration_s);
    errors.push_back(RangeOf(PhaseError_rad(DecodePhase(taps.data()).phase_rad, light.phase_rad)));
  }
  return errors;
}

struct Statistics {
  double mean = 0.0, sigma = 0.0;
};

Statistics Of(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value, squares += value * value;
  const double n = static_cast<double>(values.size());
  return {sum / n, std::sqrt(squares / n - sum / n * (sum / n))};
}

TEST(TofNoise, FollowsThePublishedLawForThisPixel) {
  EXPECT_NEAR(RangeSigma_m(9.2e4, 0.0, 0.5, 0.0, 20e6), 5.56e-3, 0.01e-3);  // 0.844 m / (0.5 sqrt(9.2e4))
  for (const double signal_e : {50.0, 1e4, 3e6})
    for (const double background_e : {0.0, 1e3, 4e7})
      for (const double read_e : {0.0, 100.0})
        EXPECT_DOUBLE_EQ(RangeSigma_m(signal_e, background_e, 0.4, read_e, 30e6),
                         Law_m(signal_e, background_e, 0.4, read_e, 30e6));
}

struct Conditions {
  double background_per_signal, background_e, read_e;
};

TEST(TofNoise, FollowsTheLawOverFiveDecadesOfSignal) {
  // Without background and read noise; with background in proportion, fixed background or read noise; with all of them.
  for (const Conditions& with : {Conditions{0, 0, 0}, {3, 0, 0}, {0, 2000, 0}, {0, 0, 20}, {0.5, 500, 10}}) {
    DepthCameraSheet sheet = Pmd3k();
    sheet.read_noise_e = with.read_e;
    DepthCameraErrors errors;
    errors.dark_e_per_us = 0.0;
    const Chip chip(sheet, errors, kNoise);
    int decades = 0;
    for (double signal_e = 100.0; decades < 6; signal_e *= 10.0) {
      const double background_e = with.background_per_signal * signal_e + with.background_e;
      const double law_m = Law_m(signal_e, background_e, 0.9, with.read_e);
      if (PhaseOf(law_m) > 0.12) continue;  // not small: the law's own error is half of this squared
      const Light light{signal_e, 0.4 + 0.9 * decades, background_e, 0.9};
      const Statistics found = Of(RangeErrors(chip, light));
      EXPECT_NEAR(found.sigma / law_m, 1.0, 0.03) << signal_e << " and " << background_e << " e, " << with.read_e;
      EXPECT_NEAR(found.mean, 0.0, 4.0 * law_m / std::sqrt(20000.0)) << signal_e << " and " << background_e << " e";
      ++decades;
    }
  }
}

// Predicted sigma [mm] for three cameras and walls at 0.5, 1, 2, 3, 4, 5, 7 m, and half of their last digit.
constexpr double kSaturated_mm = -1.0;
constexpr double kRanges_m[7] = {0.5, 1, 2, 3, 4, 5, 7};
struct Prediction {
  DepthCameraSheet sheet;
  double albedo, integration_s, sigma_mm[7];
};

std::vector<Prediction> Predictions() {
  constexpr double kSat = kSaturated_mm;
  return {{Pmd3k(), 0.9, 1e-4, {2.3, 5.3, 14.7, 29.6, 50.3, 76.9, 148}},
          {Pmd3k(), 0.5, 1e-4, {3.2, 8.0, 24.3, 50.9, 88.1, 136, 263}},
          {Pmd3k(), 0.5, 1e-3, {kSat, 1.9, 4.3, 7.4, 11.3, 16.2, 29.1}},
          {Pmd3k(), 0.1, 1e-3, {2.2, 5.0, 13.5, 27.0, 45.6, 69.5, 133}},
          {Pmd3k(), 0.5, 5e-3, {kSat, kSat, 1.7, 2.7, 3.8, 5.0, 7.8}},
          {CamCube(), 0.5, 1e-3, {kSat, 3.4, 7.3, 12.3, 18.5, 26.2, 46.1}},
          {Pmd19k(), 0.5, 1e-3, {kSat, 4.9, 11.2, 20.0, 31.6, 46.3, 85.1}}};
}

TEST(TofNoise, HasThePredictedSigmaInEveryCellBelow200mm) {
  int cells = 0;
  for (const Prediction& row : Predictions()) {
    const Chip chip(row.sheet, {}, kNoise);
    for (int i = 0; i < 7; ++i) {
      const double printed_mm = row.sigma_mm[i];
      if (printed_mm == kSaturated_mm || printed_mm >= 200.0) continue;
      const Light light = WallLight(row.sheet, row.albedo, row.integration_s, kRanges_m[i]);
      const double sigma_mm = 1e3 * Of(RangeErrors(chip, light, 20000, row.integration_s)).sigma;
      const double law_mm = 1e3 * Law_m(light.signal_e, 0.0, 0.45, row.sheet.read_noise_e);
      const double half_digit_mm = printed_mm < 100.0 ? 0.05 : 0.5;
      EXPECT_NEAR(sigma_mm / law_mm, 1.0, 0.03) << printed_mm << " mm at " << kRanges_m[i] << " m";
      EXPECT_NEAR(sigma_mm, printed_mm, 0.03 * printed_mm + half_digit_mm) << "at " << kRanges_m[i] << " m";
      ++cells;
    }
  }
  EXPECT_EQ(cells, 43);  // of 49, 5 saturate and 1 is above 200 mm
}

TEST(TofSaturation, IsFlaggedInTheCellsPredictedSaturatedAndInNoOther) {
  for (const Prediction& row : Predictions()) {
    const Chip chip(row.sheet, {}, Only(&TofEffects::noise, &TofEffects::saturation));
    for (int i = 0; i < 7; ++i) {
      const FourTaps taps =
          ExposeFour(chip, WallLight(row.sheet, row.albedo, row.integration_s, kRanges_m[i]), 0, {}, row.integration_s);
      EXPECT_EQ(std::ranges::any_of(taps, &Taps::saturated), row.sigma_mm[i] == kSaturated_mm)
          << row.albedo << ", " << row.integration_s << " s, " << kRanges_m[i] << " m";
    }
  }
}

TEST(TofNoise, HardlyGrowsByTheDefaultDarkCurrent) {
  // Compared with the read noise of the quietest camera, in the longest of its usual sub-frames.
  const double dark_e = DepthCameraErrors{}.dark_e_per_us * 5000.0;
  EXPECT_LT(std::sqrt(1.0 + dark_e / (2.0 * 100.0 * 100.0)) - 1.0, 0.01);
}

TEST(TofNoise, CountsDarkCurrentAsBackground) {
  DepthCameraErrors errors;
  errors.dark_e_per_us = 300.0;
  const Light light{.signal_e = 1e5, .phase_rad = 2.0};
  for (const double integration_s : {1e-4, 1e-3, 4e-3}) {
    const double dark_e = 300.0 * integration_s * 1e6;
    const Statistics found = Of(RangeErrors(Chip(Pmd3k(), errors, kNoise), light, 20000, integration_s));
    EXPECT_NEAR(found.sigma / Law_m(1e5, dark_e, 0.45, 200.0), 1.0, 0.03) << integration_s;
  }
  // It brings electrons only together with its noise.
  const FourTaps taps = ExposeFour(Chip(Pmd3k(), errors, kIdealTof), light);
  EXPECT_NEAR(taps[0].a_e + taps[0].b_e, 1e5, 1e-6);
}

TEST(TofNoise, GainsTheQuantisationTermFromTheConverter) {
  // 12 bits with black at 700: a count is 1.5e6 / 3395 = 441.8 e, twice a tap's own noise, which so smooths the steps.
  DepthCameraErrors errors;
  errors.adc_bits = 12.0, errors.adc_black_dn = 700.0;
  const TofEffects with_adc = Only(&TofEffects::noise, &TofEffects::adc);
  const double quantum_e = 1.5e6 / (4095.0 - 700.0);
  EXPECT_NEAR(Chip(Pmd3k(), errors, with_adc).quantum_e(), quantum_e, 1e-9);
  for (const double phase_rad : {0.3, 1.9, 4.0}) {
    const Light light{.signal_e = 2e4, .phase_rad = phase_rad};
    const double without = Of(RangeErrors(Chip(Pmd3k(), errors, kNoise), light)).sigma;
    const double with = Of(RangeErrors(Chip(Pmd3k(), errors, with_adc), light)).sigma;
    const double read_e = std::sqrt(200.0 * 200.0 + quantum_e * quantum_e / 12.0);
    EXPECT_NEAR(with / Law_m(2e4, 0.0, 0.45, read_e), 1.0, 0.03);
    EXPECT_NEAR(with / without, std::sqrt((2e4 + 2.0 * read_e * read_e) / (2e4 + 8e4)), 0.03);
    EXPECT_GT(with / without, 1.1);
  }
}

TEST(TofNoise, PredictsTheVarianceOfATapsDifference) {
  DepthCameraErrors errors;
  errors.adc_bits = 12.0, errors.dark_e_per_us = 5.0;
  const Chip chip(Pmd3k(), errors, Only(&TofEffects::noise, &TofEffects::adc, &TofEffects::sbi));
  const Chip mean(Pmd3k(), errors, Only(&TofEffects::sbi));
  for (const Light& light : {Light{2e4, 0.7}, Light{3e5, 2.0}, Light{2e5, 1.0, 5e6}}) {
    std::vector<double> differences;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      const Taps taps = ExposeFour(chip, light, i)[0];
      differences.push_back(taps.a_e - taps.b_e);
    }
    const double expected_e = std::sqrt(chip.DifferenceVariance_e2(ExposeFour(mean, light)[0], 1e-3));
    EXPECT_NEAR(Of(differences).sigma / expected_e, 1.0, 0.03) << light.background_e;
  }
  EXPECT_EQ(mean.DifferenceVariance_e2(ExposeFour(mean, {2e4, 0.7})[0], 1e-3), 0.0);
}

// Least-squares slope of log sigma over log x.
double Slope(const std::vector<double>& at, const std::function<double(double)>& sigma_m) {
  double sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  for (const double value : at) {
    const double x = std::log(value), y = std::log(sigma_m(value));
    sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  }
  const double n = static_cast<double>(at.size());
  return (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

// sigma = 0.844 m / (C sqrt(N_s)) without read noise, 0.844 m sqrt(2) r / (C N_s) where it is all; N_s ~ rho T / d^2.
TEST(TofNoise, GrowsWithTheFirstPowerOfRangeAndFallsWithTheRootOfTimeInShotNoise) {
  DepthCameraSheet sheet = Pmd3k();
  sheet.read_noise_e = 0.0;
  const Chip chip(sheet, {}, kNoise);
  const auto sigma_m = [&](double range_m, double integration_s) {
    return Of(RangeErrors(chip, WallLight(sheet, 0.5, integration_s, range_m), 30000, integration_s)).sigma;
  };
  EXPECT_NEAR(Slope({0.5, 1.0, 2.0, 4.0, 7.0}, [&](double d_m) { return sigma_m(d_m, 1e-3); }), 1.0, 0.05);
  EXPECT_NEAR(Slope({1e-4, 3e-4, 1e-3, 5e-3}, [&](double t_s) { return sigma_m(2.0, t_s); }), -0.5, 0.05);
}

TEST(TofNoise, GrowsWithTheSquareOfRangeAndFallsWithTimeInReadNoise) {
  DepthCameraSheet sheet = Pmd3k();
  sheet.read_noise_e = 5000.0;  // 2 r^2 = 5e7 e^2; at most 5e5 e of signal
  const Chip chip(sheet, {}, kNoise);
  const auto sigma_m = [&](double range_m, double integration_s) {
    return Of(RangeErrors(chip, WallLight(sheet, 0.5, integration_s, range_m), 30000, integration_s)).sigma;
  };
  EXPECT_NEAR(Slope({1.5, 2.0, 2.5, 3.0}, [&](double d_m) { return sigma_m(d_m, 1e-3); }), 2.0, 0.05);
  EXPECT_NEAR(Slope({5e-4, 1e-3, 2e-3}, [&](double t_s) { return sigma_m(2.0, t_s); }), -1.0, 0.05);
}

TEST(TofNoise, GrowsWithTheSquareOfRangeAndFallsWithTheRootOfTimeInSunlight) {
  // Background electrons grow with time as the signal does, and do not depend on range.
  DepthCameraSheet sheet = Pmd3k();
  sheet.read_noise_e = 0.0;
  const Chip chip(sheet, {}, kNoise);
  const auto sigma_m = [&](double range_m, double integration_s) {
    Light light = WallLight(sheet, 0.5, integration_s, range_m);
    light.background_e = 4e10 * integration_s;
    return Of(RangeErrors(chip, light, 30000, integration_s)).sigma;
  };
  EXPECT_NEAR(Slope({1.0, 1.5, 2.0, 3.0}, [&](double d_m) { return sigma_m(d_m, 1e-3); }), 2.0, 0.05);
  EXPECT_NEAR(Slope({5e-4, 1e-3, 2e-3, 5e-3}, [&](double t_s) { return sigma_m(2.0, t_s); }), -0.5, 0.05);
}

TEST(TofNoise, HasTheOutlierShareOfLowSignals) {
  const Chip chip(Pmd3k(), {}, kNoise);
  for (const double snr : {1.0, 1.5, 2.0, 3.0}) {
    // s = sqrt(2) C N / sqrt(N + 2 r^2), solved for N. Outlier: more than a quarter turn off.
    const double h = snr * snr / (4.0 * 0.45 * 0.45);
    const double signal_e = h + std::sqrt(h * h + 2.0 * h * 2.0 * 200.0 * 200.0);
    constexpr int kPixels = 40000;
    const std::vector<double> errors_m = RangeErrors(chip, {.signal_e = signal_e, .phase_rad = 1.7}, kPixels);
    const double share =
        static_cast<double>(std::ranges::count_if(errors_m, [](double e) { return std::abs(e) > kPeriod_m / 4.0; })) /
        kPixels;
    const double expected = 0.5 * std::erfc(snr / std::numbers::sqrt2);
    EXPECT_NEAR(share, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / kPixels)) << snr;
  }
}

TEST(TofNoise, CountsSingleElectronsOfDimTaps) {
  // Poisson's distribution P(k) = m^k e^-m / k!, compared count by count, and so its mean and variance as well.
  DepthCameraSheet sheet = Pmd3k();
  sheet.read_noise_e = 0.0;
  DepthCameraErrors errors;
  errors.dark_e_per_us = 0.0;
  const Chip chip(sheet, errors, kNoise);
  constexpr int kPixels = 40000;
  for (const double mean_e : {0.3, 4.0, 30.0, 49.0}) {
    std::vector<double> taps_e, share(200);
    for (std::uint64_t i = 0; i < kPixels; ++i) {
      Random random(2, Sensor::kDepth, i);
      taps_e.push_back(chip.Expose({2.0 * mean_e, 0.0}, {}, 1e-3, random).a_e);
      ASSERT_EQ(taps_e.back(), std::floor(taps_e.back()));
      ASSERT_GE(taps_e.back(), 0.0);
      ++share.at(static_cast<std::size_t>(taps_e.back()));
    }
    const Statistics found = Of(taps_e);
    EXPECT_NEAR(found.mean, mean_e, 4.0 * std::sqrt(mean_e / kPixels));
    EXPECT_NEAR(found.sigma * found.sigma / mean_e, 1.0, 4.0 * std::sqrt((2.0 + 1.0 / mean_e) / kPixels));
    for (std::size_t k = 0; k < share.size(); ++k) {
      const double count = static_cast<double>(k);
      const double expected = std::exp(count * std::log(mean_e) - mean_e - std::lgamma(count + 1.0));
      EXPECT_NEAR(share[k] / kPixels, expected, 5.0 * std::sqrt(expected / kPixels) + 1e-4) << mean_e << " e, " << k;
    }
  }
}

TEST(TofNoise, KeepsMeanAndVarianceWherePoissonBecomesGaussian) {
  const Chip chip(Pmd3k(), {}, kNoise);
  for (const double mean_e : {0.0, 10.0, 49.9, 50.1, 200.0}) {
    std::vector<double> taps_e;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      Random random(3, Sensor::kDepth, i);
      taps_e.push_back(chip.Expose({2.0 * mean_e, 0.0}, {}, 0.0, random).b_e);
    }
    const double variance_e2 = mean_e + 200.0 * 200.0;
    EXPECT_NEAR(Of(taps_e).mean, mean_e, 4.0 * std::sqrt(variance_e2 / 20000.0));
    EXPECT_NEAR(Of(taps_e).sigma / std::sqrt(variance_e2), 1.0, 0.03);
  }
}

TEST(TofNoise, IsGaussianInAPixel) {
  const Chip chip(Pmd3k(), {}, kNoise);
  for (const double signal_e : {2e4, 1e6}) {
    std::vector<double> errors_m = RangeErrors(chip, {.signal_e = signal_e, .phase_rad = 5.5});
    std::ranges::sort(errors_m);
    const double law_m = Law_m(signal_e, 0.0, 0.45, 200.0), n = static_cast<double>(errors_m.size());
    double distance = 0.0;  // Kolmogorov-Smirnov distance
    for (std::size_t i = 0; i < errors_m.size(); ++i) {
      const double below = 0.5 * std::erfc(-errors_m[i] / law_m / std::numbers::sqrt2);
      distance = std::max({distance, below - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - below});
    }
    EXPECT_LT(distance, 1.63 / std::sqrt(n)) << signal_e;  // exceeded by chance once in a hundred
  }
}

TEST(TofNoise, OfTapsAndSubFramesIsIndependent) {
  const Chip chip(Pmd3k(), {}, kNoise);
  const Light light{.signal_e = 1e5, .phase_rad = 0.9};
  const FourTaps mean = ExposeFour(Chip(Pmd3k(), {}, kIdealTof), light);
  std::array<std::array<double, 8>, 8> products{};
  constexpr int kPixels = 20000;
  for (std::uint64_t i = 0; i < kPixels; ++i) {
    const FourTaps taps = ExposeFour(chip, light, i);
    std::array<double, 8> e{};
    for (std::size_t k = 0; k < 4; ++k) {
      e[2 * k] = (taps[k].a_e - mean[k].a_e) / std::sqrt(mean[k].a_e + 4e4);
      e[2 * k + 1] = (taps[k].b_e - mean[k].b_e) / std::sqrt(mean[k].b_e + 4e4);
    }
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t b = 0; b < 8; ++b) products[a][b] += e[a] * e[b] / kPixels;
  }
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t b = 0; b < 8; ++b)
      EXPECT_NEAR(products[a][b], a == b ? 1.0 : 0.0, 4.5 * std::sqrt((a == b ? 2.0 : 1.0) / kPixels)) << a << b;
}

}  // namespace
}  // namespace merlin::sim
