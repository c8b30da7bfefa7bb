#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/sim/tof/pixel.h"

namespace merlin::sim {
namespace {

double FullestTap_e(const FourTaps& taps) {
  double fullest_e = 0.0;
  for (const Taps& tap : taps) fullest_e = std::max({fullest_e, tap.a_e, tap.b_e});
  return fullest_e;
}

PhaseReading ReadingOf(const Chip& chip, const Light& light, const PixelTraits& traits = {}) {
  return DecodePhase(ExposeFour(chip, light, 0, traits).data());
}

TEST(TofChip, TakesTheTapsOfTheFourPhaseAlgorithm) {
  // Phase 45 degrees: m = C N sqrt(1/2) (1, -1, -1, 1).
  const FourTaps taps =
      ExposeFour(Chip(Pmd3k(), {}, kIdealTof), {.signal_e = 1000.0, .phase_rad = std::numbers::pi / 4.0});
  const double m_e = 450.0 * std::sqrt(0.5);
  const double sign[4] = {1, -1, -1, 1};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(taps[k].a_e, (1000.0 + sign[k] * m_e) / 2.0, 1e-9);
    EXPECT_NEAR(taps[k].b_e, (1000.0 - sign[k] * m_e) / 2.0, 1e-9);
    EXPECT_EQ(taps[k].suppressed_e, 0.0);
    EXPECT_FALSE(taps[k].saturated);
  }
  const PhaseReading reading = DecodePhase(taps.data());
  EXPECT_NEAR(reading.phase_rad, std::numbers::pi / 4.0, 1e-12);
  EXPECT_NEAR(reading.amplitude_e, 450.0, 1e-9);
}

TEST(TofChip, DoublesAmplitudeAndKeepsPhaseWithTwiceTheLight) {
  const Chip chip(Pmd3k(), {}, kIdealTof);
  const Light once = WallLight(Pmd3k(), 0.3, 1e-3, 2.345);
  const PhaseReading one = ReadingOf(chip, once);
  EXPECT_NEAR(RangeOf(one.phase_rad), 2.345, 1e-12);
  for (const Light& twice : {WallLight(Pmd3k(), 0.6, 1e-3, 2.345), WallLight(Pmd3k(), 0.3, 2e-3, 2.345)}) {
    EXPECT_NEAR(ReadingOf(chip, twice).phase_rad, one.phase_rad, 1e-12);
    EXPECT_NEAR(ReadingOf(chip, twice).amplitude_e / one.amplitude_e, 2.0, 1e-12);
  }
}

Taps TapsOf(double difference_e) { return {.a_e = difference_e, .b_e = 0.0}; }

TEST(TofPhase, IsFoundInEveryQuadrantAndOnTheAxes) {
  for (int step = 0; step < 64; ++step) {
    const double phase_rad = 2.0 * std::numbers::pi * step / 64.0;
    Taps taps[4];
    for (int k = 0; k < 4; ++k)
      taps[k] = {.a_e = 500.0 + 7.0 * std::cos(phase_rad + k * std::numbers::pi / 2.0), .b_e = 490.0};
    EXPECT_NEAR(PhaseError_rad(DecodePhase(taps).phase_rad, phase_rad), 0.0, 1e-12) << step;
    EXPECT_NEAR(DecodePhase(taps).amplitude_e, 7.0, 1e-11);
  }
  const Taps left[4] = {TapsOf(-1), TapsOf(0), TapsOf(1), TapsOf(0)};  // I = -2, Q = 0
  EXPECT_DOUBLE_EQ(DecodePhase(left).phase_rad, std::numbers::pi);
  const Taps down[4] = {TapsOf(0), TapsOf(1), TapsOf(0), TapsOf(-1)};  // I = 0, Q = -2
  EXPECT_DOUBLE_EQ(DecodePhase(down).phase_rad, 1.5 * std::numbers::pi);
}

TEST(TofPhase, StaysBelowAWholeTurnAndIsZeroInTheDark) {
  for (const double tiny : {1e-3, 1e-9, 1e-15, 1e-16, 1e-20, 1e-300}) {
    const Taps taps[4] = {TapsOf(1), TapsOf(tiny), TapsOf(0), TapsOf(0)};  // -tiny rad
    const double phase_rad = DecodePhase(taps).phase_rad;
    EXPECT_GE(phase_rad, 0.0) << tiny;
    EXPECT_LT(phase_rad, 2.0 * std::numbers::pi) << tiny;
    EXPECT_NEAR(PhaseError_rad(phase_rad, -std::atan(tiny)), 0.0, 1e-15);
  }
  const Taps dark[4] = {};
  EXPECT_EQ(DecodePhase(dark).phase_rad, 0.0);
  EXPECT_EQ(DecodePhase(dark).amplitude_e, 0.0);
}

TEST(TofSaturation, ClipsExactlyWhenTheFullestTapOverflows) {
  // It is (1 + C max(|cos|, |sin|)) N / 2.
  const Chip chip(Pmd3k(), {}, Only(&TofEffects::saturation));
  int clipped = 0, kept = 0;
  for (int step = 0; step < 40; ++step) {
    const double phase_rad = 2.0 * std::numbers::pi * step / 40.0;
    const double share = (1.0 + 0.45 * std::max(std::abs(std::cos(phase_rad)), std::abs(std::sin(phase_rad)))) / 2.0;
    for (const double filling : {0.1, 0.9, 0.999999, 1.000001, 1.1, 1.5, 3.0, 100.0}) {
      const FourTaps taps = ExposeFour(chip, {.signal_e = filling * 1.5e6 / share, .phase_rad = phase_rad});
      EXPECT_EQ(std::ranges::any_of(taps, &Taps::saturated), filling > 1.0) << filling << " at " << phase_rad;
      EXPECT_NEAR(FullestTap_e(taps), 1.5e6 * std::min(filling, 1.0), 1e-6);
      ++(filling > 1.0 ? clipped : kept);
    }
  }
  EXPECT_EQ(clipped, 40 * 5);
  EXPECT_EQ(kept, 40 * 3);
}

TEST(TofSaturation, OfOneTapFlagsItsSubFrameOnly) {
  const Chip chip(Pmd3k(), {}, Only(&TofEffects::saturation));
  // Phase 0, 2.2e6 e: the taps of k = 0 hold 1.1e6 (1 +- 0.45), those of k = 1 1.1e6 each.
  const FourTaps taps = ExposeFour(chip, {.signal_e = 2.2e6});
  EXPECT_TRUE(taps[0].saturated);
  EXPECT_FALSE(taps[1].saturated);
  EXPECT_TRUE(taps[2].saturated);
  EXPECT_FALSE(taps[3].saturated);
  EXPECT_EQ(taps[0].a_e, 1.5e6);
  EXPECT_NEAR(taps[0].b_e, 1.1e6 * 0.55, 1e-6);
}

TEST(TofSaturation, ReachesFartherWithLongerIntegration) {
  // The distance where (1 + C max(|cos|, |sin|)) K rho T / (2 d^2) = 1.5e6: proportional to sqrt(T) apart from the
  // phase.
  const Chip chip(Pmd3k(), {}, Only(&TofEffects::saturation));
  double last_m = 0.0;
  for (const double integration_s : {1e-4, 3e-4, 1e-3, 2e-3, 5e-3}) {
    double farthest_m = 0.0;
    for (double range_m = 0.05; range_m < 4.0; range_m += 0.005)
      if (std::ranges::any_of(ExposeFour(chip, WallLight(Pmd3k(), 0.5, integration_s, range_m)), &Taps::saturated))
        farthest_m = range_m;
    const double at_contrast_0_m = std::sqrt(2000.0 * 0.5 * integration_s * 1e6 / 3e6);
    EXPECT_GE(farthest_m, at_contrast_0_m * std::sqrt(1.0 + 0.45 * std::sqrt(0.5)) - 0.005);
    EXPECT_LE(farthest_m, at_contrast_0_m * std::sqrt(1.45));
    EXPECT_GT(farthest_m, last_m);
    last_m = farthest_m;
  }
}

TEST(TofSaturation, LeavesTapsAloneWhenSwitchedOff) {
  const FourTaps taps = ExposeFour(Chip(Pmd3k(), {}, kIdealTof), {.signal_e = 1e8});
  EXPECT_NEAR(taps[0].a_e, 1.45 * 5e7, 1e-3);
  EXPECT_FALSE(taps[0].saturated);
}

// A facing wall of albedo 0.5 at 1 m, 1 ms, in full sun: 1e6 e from the lamp, and from the sun (80 W/m2 against 2 W/sr)
// 40 times that.
const Light kSunlit{.signal_e = 1e6, .phase_rad = 2.0 * std::numbers::pi / kPeriod_m, .background_e = 4e7};

TEST(TofSbi, KeepsAPixelInFullSunAliveAndRightInTheMean) {
  const TofEffects with = Only(&TofEffects::noise, &TofEffects::saturation, &TofEffects::sbi);
  const Chip chip(Pmd3k(), {}, with);
  // SBI removes what the emptier tap holds above half a full well; each removed electron adds 1.5 e2 of variance.
  double variance_of_i = 0.0, variance_of_q = 0.0;
  for (int k = 0; k < 4; ++k) {
    const double m_e = std::abs(kSunlit.At(k).correlation_e), taken_e = (4.1e7 - m_e) / 2.0 - 0.75e6;
    EXPECT_NEAR(ExposeFour(chip, kSunlit)[static_cast<std::size_t>(k)].suppressed_e / taken_e, 1.0, 1e-4);
    (k % 2 == 0 ? variance_of_i : variance_of_q) += 1.5e6 + m_e + 2.0 * 1.5 * taken_e + 8e4;
  }
  const double c = std::cos(kSunlit.phase_rad), s = std::sin(kSunlit.phase_rad);
  const double law_rad = std::sqrt(c * c * variance_of_q + s * s * variance_of_i) / (2.0 * 0.45e6);
  double sum = 0.0, squares = 0.0;
  constexpr int kPixels = 20000;
  for (std::uint64_t i = 0; i < kPixels; ++i) {
    const FourTaps taps = ExposeFour(chip, kSunlit, i);
    ASSERT_FALSE(std::ranges::any_of(taps, &Taps::saturated));
    const double error_rad = PhaseError_rad(DecodePhase(taps.data()).phase_rad, kSunlit.phase_rad);
    sum += error_rad, squares += error_rad * error_rad;
  }
  EXPECT_NEAR(sum / kPixels, 0.0, 4.0 * law_rad / std::sqrt(kPixels));
  EXPECT_NEAR(std::sqrt(squares / kPixels) / law_rad, 1.0, 0.03);
  EXPECT_GT(law_rad, 1.15 * std::sqrt((4.1e7 + 8e4) / 2.0) / 0.45e6);  // worse than the sun's shot noise alone
}

TEST(TofSbi, MakesTheDifferenceBetweenDeadAndAlive) {
  const TofEffects without = Only(&TofEffects::saturation), with = Only(&TofEffects::saturation, &TofEffects::sbi);
  for (const DepthCameraSheet& sheet : {Pmd3k(), Pmd19k(), CamCube()}) {
    const FourTaps full = ExposeFour(Chip(sheet, {}, without), kSunlit);
    EXPECT_TRUE(std::ranges::all_of(full, &Taps::saturated));
    EXPECT_EQ(DecodePhase(full.data()).amplitude_e, 0.0);  // both taps are full: no signal is left
  }
  // The 160x120 chip has no SBI, so the effect does nothing there. A tenth of the sun fills its wells as well.
  EXPECT_TRUE(std::ranges::all_of(ExposeFour(Chip(Pmd19k(), {}, with), kSunlit), &Taps::saturated));
  const FourTaps patch = ExposeFour(Chip(Pmd19k(), {}, with), {.signal_e = 1.65e5, .background_e = 6.6e5});
  EXPECT_TRUE(std::ranges::all_of(patch, &Taps::saturated));
  EXPECT_EQ(patch[0].suppressed_e, 0.0);
  EXPECT_FALSE(std::ranges::any_of(ExposeFour(Chip(Pmd3k(), {}, with), kSunlit), &Taps::saturated));
}

TEST(TofSbi, SleepsBelowItsOnsetAndGivesUpAboveItsMost) {
  const Chip chip(Pmd3k(), {}, Only(&TofEffects::sbi));
  Random random(1, Sensor::kDepth, 0);
  const auto expose = [&](double total_e, double m_e) { return chip.Expose({total_e, m_e}, {}, 1e-3, random); };
  EXPECT_EQ(expose(1.5e6, 0.0).suppressed_e, 0.0);  // 0.75e6 each: half full
  EXPECT_NEAR(expose(1.6e6, 0.0).suppressed_e, 0.05e6, 1e-6);
  EXPECT_EQ(expose(1.6e6, 0.1e6).suppressed_e, 0.0);  // the emptier tap decides
  EXPECT_NEAR(expose(1e9, 0.0).suppressed_e, 75e6, 1e-6);
  const Taps taps = expose(4e6, 0.3e6);
  EXPECT_NEAR(taps.a_e - taps.b_e, 0.3e6, 1e-6);
  EXPECT_NEAR(taps.b_e, 0.75e6, 1e-6);
}

TEST(TofResponse, MakesAnErrorOfFourfoldPhaseThatGrowsWithAmplitude) {
  // D' = D - g (A^3 - B^3) / F^2 and A^3 - B^3 = (3 N^2 D + D^3) / 4: of cos^3 = (3 cos + cos 3) / 4 the last part is a
  // third harmonic. Its share of the first gives -share sin(4 phase).
  DepthCameraErrors errors;
  errors.response_cubic = 0.03;
  const Chip chip(Pmd3k(), errors, Only(&TofEffects::intensity));
  double last_peak_rad = 0.0;
  for (const double filling : {0.05, 0.3, 0.8, 1.3}) {
    const double x = 0.03 * filling * filling;  // of N: tap about filling / 2
    const double share = -x * 0.45 * 0.45 / 16.0 / (1.0 - 0.75 * x - 3.0 / 16.0 * x * 0.45 * 0.45);
    double peak_rad = 0.0, quadratic_rad = 0.0;
    for (int step = 0; step < 32; ++step) {
      const Light light{.signal_e = filling * 1.5e6, .phase_rad = 2.0 * std::numbers::pi * step / 32.0};
      const double error_rad = PhaseError_rad(ReadingOf(chip, light).phase_rad, light.phase_rad);
      EXPECT_NEAR(error_rad, -share * std::sin(4.0 * light.phase_rad), 0.01 * std::abs(share) + 1e-12);
      peak_rad = std::max(peak_rad, std::abs(error_rad));
      // A quadratic response would cause no such error, because A^2 - B^2 = N D is proportional to D.
      FourTaps bent = ExposeFour(Chip(Pmd3k(), {}, kIdealTof), light);
      for (Taps& taps : bent)
        for (double* tap : {&taps.a_e, &taps.b_e}) *tap -= 0.03 * *tap * *tap / 1.5e6;
      quadratic_rad =
          std::max(quadratic_rad, std::abs(PhaseError_rad(DecodePhase(bent.data()).phase_rad, light.phase_rad)));
    }
    EXPECT_GT(peak_rad, last_peak_rad);
    EXPECT_LT(quadratic_rad, 1e-12);
    last_peak_rad = peak_rad;
  }
  EXPECT_GT(last_peak_rad, 5e-4);  // 0.6 mm
}

TEST(TofChip, SeesNothingWithADeadPixel) {
  const Chip chip(Pmd3k(), {}, kIdealTof);
  const FourTaps taps = ExposeFour(chip, {.signal_e = 1e6, .phase_rad = 1.0}, 0, {.dead = true});
  for (const Taps& tap : taps) EXPECT_EQ(tap.a_e + tap.b_e, 0.0);
  EXPECT_EQ(DecodePhase(taps.data()).amplitude_e, 0.0);
}

TEST(TofChip, HasAHotPixelAlwaysFullWhetherOrNotItSuppressesBackground) {
  for (const DepthCameraSheet& sheet : {Pmd3k(), Pmd19k()}) {
    const Chip chip(sheet, {}, Only(&TofEffects::saturation, &TofEffects::sbi, &TofEffects::dead_pixels));
    for (const double signal_e : {0.0, 1e4, 1e6}) {
      const FourTaps taps = ExposeFour(chip, {.signal_e = signal_e, .phase_rad = 1.0}, 0, {.hot = true});
      for (const Taps& tap : taps) {
        EXPECT_TRUE(tap.saturated) << signal_e;
        EXPECT_EQ(tap.a_e, sheet.full_well_e) << signal_e;
        EXPECT_EQ(tap.b_e, sheet.full_well_e) << signal_e;
      }
    }
  }
}

TEST(TofChip, CancelsGainAndOffsetOfTheTapsForAPixelAtRest) {
  // A (1 + g) - B (1 - g) = D + g N. The term g N is the same in all four sub-frames and cancels in D_0 - D_2 and D_3 -
  // D_1; the offset cancels within each sub-frame.
  const Chip chip(Pmd3k(), {}, kIdealTof);
  for (const double phase_rad : {0.0, 0.7, 3.0, 6.2}) {
    const Light light{.signal_e = 2e5, .phase_rad = phase_rad, .background_e = 3e5};
    const PhaseReading plain = ReadingOf(chip, light),
                       odd = ReadingOf(chip, light, {.gain = 0.02f, .offset_e = -300.0f});
    EXPECT_NEAR(PhaseError_rad(odd.phase_rad, plain.phase_rad), 0.0, 1e-12);
    EXPECT_NEAR(odd.amplitude_e / plain.amplitude_e, 1.0, 1e-12);
    const FourTaps taps = ExposeFour(chip, light, 0, {.gain = 0.02f, .offset_e = -300.0f});
    EXPECT_NEAR(taps[0].a_e, 0.5 * (5e5 + 9e4 * std::cos(phase_rad)) * 1.02 - 300.0, 0.01);
    EXPECT_NEAR(taps[0].b_e, 0.5 * (5e5 - 9e4 * std::cos(phase_rad)) * 0.98 - 300.0, 0.01);
  }
}

TEST(TofConverter, RisesInWholeCountsAndErrsByHalfOfOneAtMost) {
  DepthCameraErrors errors;
  errors.adc_bits = 8.0, errors.adc_black_dn = 11.0;
  const Chip chip(Pmd3k(), errors, Only(&TofEffects::adc));
  const double quantum_e = 1.5e6 / (255.0 - 11.0);  // black to full well
  EXPECT_NEAR(chip.quantum_e(), quantum_e, 1e-9);
  Random random(1, Sensor::kDepth, 0);
  double last_e = -1.0;
  std::vector<double> codes;
  for (int i = 0; i <= 5000; ++i) {
    const double tap_e = 1.5e6 * i / 5000.0;
    const double converted_e = chip.Expose({2.0 * tap_e, 0.0}, {}, 1e-3, random).a_e;
    EXPECT_LE(std::abs(converted_e - tap_e), 0.5 * quantum_e * (1.0 + 1e-9));
    EXPECT_NEAR(std::remainder(converted_e, quantum_e), 0.0, 1e-6);
    EXPECT_GE(converted_e, last_e);
    if (converted_e != last_e) codes.push_back(converted_e);
    last_e = converted_e;
  }
  EXPECT_EQ(codes.size(), 245u);  // every code from black to the top
}

TEST(TofConverter, ClipsAtItsEndsAndMeasuresBelowBlack) {
  DepthCameraErrors errors;
  errors.adc_bits = 8.0, errors.adc_black_dn = 11.0;
  const Chip chip(Pmd3k(), errors, Only(&TofEffects::adc));
  const double quantum_e = 1.5e6 / 244.0;
  Random random(1, Sensor::kDepth, 0);
  const auto converted_e = [&](double tap_e) {
    return chip.Expose({}, {.offset_e = static_cast<float>(tap_e)}, 1e-3, random).a_e;
  };
  EXPECT_EQ(converted_e(0.0), 0.0);
  EXPECT_NEAR(converted_e(1e9), 1.5e6, 1e-6);
  EXPECT_NEAR(converted_e(-3.2 * quantum_e), -3.0 * quantum_e, 1e-6);  // black leaves room for the noise
  EXPECT_NEAR(converted_e(-1e9), -11.0 * quantum_e, 1e-6);
}

// Share of pixels at rest that are called inconsistent.
double InconsistentShare(const Chip& chip, const Light& light, const PixelTraits& traits = {}, int pixels = 20000) {
  int found = 0;
  for (int i = 0; i < pixels; ++i) {
    const FourTaps taps = ExposeFour(chip, light, static_cast<std::uint64_t>(i), traits);
    found += Inconsistent(taps.data(), DecodePhase(taps.data()).amplitude_e, 200.0);
  }
  return static_cast<double>(found) / pixels;
}

TEST(TofConsistency, HoldsForPixelsAtRestInAnyLight) {
  const Chip chip(Pmd3k(), {}, Only(&TofEffects::noise, &TofEffects::adc, &TofEffects::saturation, &TofEffects::sbi));
  // Two residuals, each beyond 4 sigma once in 15,800: 2.5 of 20,000 pixels; 10 are all but impossible.
  for (const Light& light : {Light{0.0}, Light{500.0, 1.0}, Light{2e4, 2.0}, Light{1e6, 3.0}, Light{2e4, 2.0, 1e6},
                             Light{1e4, 0.5, 4e7}, kSunlit})
    EXPECT_LE(InconsistentShare(chip, light), 10.0 / 20000.0) << light.signal_e << " e, " << light.background_e;
}

TEST(TofConsistency, BreaksForSubFramesOfTwoDepths) {
  const Chip chip(Pmd3k(), {}, Only(&TofEffects::noise));
  const FourTaps near = ExposeFour(chip, WallLight(Pmd3k(), 0.5, 1e-3, 1.0), 0);
  // By hand, D in 1e5 e: near 3.01 -3.34 -3.01 3.34, far -0.33 -0.01 0.33 0.01; misses of the sums, as shares of the
  // modulation that is read: 1.25 after one sub-frame, 0.78 after two, 0.48 after three.
  const FourTaps far = ExposeFour(chip, WallLight(Pmd3k(), 0.5, 1e-3, 3.7), 1);
  for (int edge = 1; edge < 4; ++edge) {  // the near surface leaves after this many sub-frames
    FourTaps taps = far;
    std::copy_n(near.begin(), edge, taps.begin());
    EXPECT_TRUE(Inconsistent(taps.data(), DecodePhase(taps.data()).amplitude_e, 200.0)) << edge;
  }
  EXPECT_FALSE(Inconsistent(near.data(), DecodePhase(near.data()).amplitude_e, 200.0));
  EXPECT_FALSE(Inconsistent(far.data(), DecodePhase(far.data()).amplitude_e, 200.0));
}

TEST(TofConsistency, NeedsBothAShareOfTheModulationAndFourSigmas) {
  const auto inconsistent = [](double d0_e, double d2_e, double common_e) {
    const Taps taps[4] = {
        {common_e + d0_e, common_e}, {common_e, common_e}, {common_e + d2_e, common_e}, {common_e, common_e}};
    return Inconsistent(taps, DecodePhase(taps).amplitude_e, 0.0);
  };
  EXPECT_FALSE(inconsistent(0.0, 0.0, 0.0));
  // r = |D_0 + D_2| against 0.4 |D_0 - D_2|: D_2 = -0.4 D_0 misses by 0.6 and spans 1.4.
  EXPECT_FALSE(inconsistent(1e6, -0.45e6, 0.0));  // 0.55 / 1.45 = 0.38
  EXPECT_TRUE(inconsistent(1e6, -0.40e6, 0.0));   // 0.43
  // 4 sigma = 4 sqrt(2 * 2e6) = 8000 e of shot noise.
  EXPECT_FALSE(inconsistent(7500.0, 0.0, 1e6));
  EXPECT_TRUE(inconsistent(8500.0, 0.0, 1e6));
}

}  // namespace
}  // namespace merlin::sim
