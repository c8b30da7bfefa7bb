// Compares the colour sensor with known laws: Poisson variance of photons, cos^4 falloff, the sRGB curve of its
// standard.
#include "sim/color/color_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace merlin::sim {
namespace {

using Picture = std::vector<std::uint8_t>;

const CameraModel kCamera{.width = 200, .height = 120, .fx_px = 150.0, .fy_px = 240.0, .cx_px = 60.5, .cy_px = 80.25};
const std::size_t kValues = 3 * 200 * 120;

// Few electrons, so that the noise spans many steps.
ColorCameraSheet Noisy() {
  return {.name = "test",
          .camera = kCamera,
          .full_well_e = 400.0,
          .read_noise_e = 5.0,
          .falloff_power = 0.0,
          .exposure_nominal_s = 0.01,
          .exposure_min_s = 1e-4,
          .exposure_max_s = 0.04,
          .gain_max = 8.0};
}
ColorCameraSheet Perfect() {
  ColorCameraSheet sheet = Noisy();
  sheet.full_well_e = 1e12;
  sheet.read_noise_e = 0.0;
  return sheet;
}

double LinearOf(int value) {  // IEC 61966-2-1
  return value <= 10 ? value / 255.0 / 12.92 : std::pow((value / 255.0 + 0.055) / 1.055, 2.4);
}

Picture Exposed(const ColorCameraSheet& sheet, Picture bgr, const ColorSettings& settings, std::uint64_t seed = 1,
                std::uint64_t frame = 1) {
  ColorResponse(sheet, seed).Expose(bgr, settings, frame);
  return bgr;
}

struct Statistics {
  double mean = 0.0, variance = 0.0;
};

// Linear light according to the values of a picture.
Statistics LinearStatistics(const Picture& bgr) {
  Statistics s;
  for (const int value : bgr) s.mean += LinearOf(value) / static_cast<double>(bgr.size());
  for (const int value : bgr) s.variance += std::pow(LinearOf(value) - s.mean, 2.0) / static_cast<double>(bgr.size());
  return s;
}

TEST(ColorResponse, ShowsWhatWasRenderedWhenNominallyExposed) {
  Picture bgr(kValues);
  for (std::size_t i = 0; i < kValues; ++i) bgr[i] = static_cast<std::uint8_t>(i);
  EXPECT_EQ(Exposed(Perfect(), bgr, DefaultSettings(Perfect())), bgr);
}

TEST(ColorResponse, HasPoissonsVarianceAndTheReadNoise) {
  for (const int value : {90, 120, 180})
    for (const double exposure : {0.5, 1.0, 1.5}) {
      const ColorSettings settings{.exposure_s = 0.01 * exposure};
      const Statistics got =
          LinearStatistics(Exposed(Noisy(), Picture(kValues, static_cast<std::uint8_t>(value)), settings));
      const double electrons = 400.0 * LinearOf(value) * exposure;
      const double variance = (electrons + 25.0) / (400.0 * 400.0);
      const double five_errors = 5.0 * std::sqrt(variance / kValues);
      EXPECT_NEAR(got.mean, electrons / 400.0, five_errors + 2e-4)
          << value << " " << exposure;  // plus a quantisation step
      // Tolerance: five standard errors, plus 0.5 % for the rounding to 8 bits.
      EXPECT_NEAR(got.variance / variance, 1.0, 5.0 * std::sqrt(2.0 / kValues) + 0.005) << value << " " << exposure;
    }
}

TEST(ColorResponse, AmplifiesNoiseWithTheSignal) {
  const Picture grey(kValues, 90);
  const Statistics once = LinearStatistics(Exposed(Noisy(), grey, {.exposure_s = 0.01, .gain = 1.0}));
  const Statistics thrice = LinearStatistics(Exposed(Noisy(), grey, {.exposure_s = 0.01, .gain = 3.0}));
  EXPECT_NEAR(thrice.mean / once.mean, 3.0, 0.01);
  EXPECT_NEAR(thrice.variance / once.variance, 9.0, 0.2);
}

TEST(ColorResponse, ClipsAtTheFullWellAndAtWhite) {
  const ColorSettings twice{.exposure_s = 0.02};
  EXPECT_EQ(Exposed(Perfect(), Picture(kValues, 200), twice), Picture(kValues, 255));
  EXPECT_EQ(Exposed(Perfect(), Picture(kValues, 0), twice), Picture(kValues, 0));
  // White clipped in the well stays below white behind a factor of one half: light is lost, not dimmed.
  const Picture clipped = Exposed(Perfect(), Picture(kValues, 255), {.exposure_s = 0.02, .white_balance_red = 0.5});
  EXPECT_NEAR(LinearOf(clipped[2]), 0.5, 0.003);
  EXPECT_EQ(clipped[1], 255);
}

TEST(ColorResponse, BalancesRedAndBlueInLinearLight) {
  const ColorSettings settings{.exposure_s = 0.01, .white_balance_red = 2.0, .white_balance_blue = 0.5};
  const Picture bgr = Exposed(Perfect(), Picture(kValues, 100), settings);
  for (std::size_t i = 0; i < kValues; i += 3) {
    ASSERT_NEAR(LinearOf(bgr[i]) / LinearOf(100), 0.5, 0.01) << i;
    ASSERT_EQ(bgr[i + 1], 100) << i;
    ASSERT_NEAR(LinearOf(bgr[i + 2]) / LinearOf(100), 2.0, 0.015) << i;
  }
}

TEST(ColorResponse, FallsOffWithTheFourthPowerOfTheCosine) {
  ColorCameraSheet sheet = Perfect();
  sheet.falloff_power = 4.0;
  const Picture bgr = Exposed(sheet, Picture(kValues, 220), DefaultSettings(sheet));
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      const double x = (u - 60.5) / 150.0, y = (v - 80.25) / 240.0;
      const double expected = LinearOf(220) / std::pow(1.0 + x * x + y * y, 2.0);  // cos^2 = 1 / (1 + tan^2)
      ASSERT_NEAR(LinearOf(bgr[3 * (static_cast<std::size_t>(v) * 200 + u)]), expected, 0.005) << u << " " << v;
    }
}

TEST(ColorResponse, IsFixedBySeedFrameAndPixel) {
  const Picture grey(kValues, 120);
  const ColorSettings settings{.exposure_s = 0.01};
  const Picture a = Exposed(Noisy(), grey, settings, 1, 5);
  EXPECT_EQ(a, Exposed(Noisy(), grey, settings, 1, 5));
  EXPECT_NE(a, Exposed(Noisy(), grey, settings, 2, 5));
  EXPECT_NE(a, Exposed(Noisy(), grey, settings, 1, 6));
  EXPECT_NE(a, Exposed(Noisy(), grey, settings, 1, 5 + (1ULL << 32)));
  const Picture part = Exposed(Noisy(), Picture(1003, 120), settings, 1, 5);
  EXPECT_TRUE(std::equal(part.begin(), part.end(), a.begin()));
  EXPECT_TRUE(Exposed(Noisy(), Picture(), settings).empty());
}

TEST(ColorResponse, OfNeighboursAndOfFramesIsUncorrelated) {
  const ColorSettings settings{.exposure_s = 0.01};
  const Picture now = Exposed(Noisy(), Picture(kValues, 120), settings, 1, 5);
  const Picture next = Exposed(Noisy(), Picture(kValues, 120), settings, 1, 6);
  const Statistics s = LinearStatistics(now);
  const auto correlation = [&](const Picture& other, std::size_t step) {
    double sum = 0.0;
    for (std::size_t i = 0; i + step < kValues; ++i)
      sum += (LinearOf(now[i]) - s.mean) * (LinearOf(other[i + step]) - s.mean);
    return sum / kValues / s.variance;
  };
  const double five_errors = 5.0 / std::sqrt(kValues);
  for (const std::size_t step : {1, 2, 3, 8, 32, 480, 600})
    EXPECT_NEAR(correlation(now, step), 0.0, five_errors) << step;
  EXPECT_NEAR(correlation(next, 0), 0.0, five_errors);
}

TEST(AutoExposure, BringsDimAndBrightPicturesToAGreyCard) {
  const ColorCameraSheet sheet = Perfect();
  for (const int value : {40, 70, 118, 200, 250}) {  // linear light 0.021 to 0.96
    ColorSettings settings = DefaultSettings(sheet);
    double light = 0.0;
    for (int frame = 0; frame < 20; ++frame) {
      const Picture bgr = Exposed(sheet, Picture(kValues, static_cast<std::uint8_t>(value)), settings);
      light = LinearStatistics(bgr).mean;
      settings = NextExposure(sheet, settings, bgr);
      EXPECT_NO_THROW(CheckSettings(sheet, settings));
    }
    EXPECT_LT(std::abs(std::log2(light / 0.18)), 0.25 + 0.03) << value;
  }
}

TEST(AutoExposure, GoesNoFartherThanTheSheetAndRests) {
  const ColorCameraSheet sheet = Perfect();
  ColorSettings dark = DefaultSettings(sheet), bright = dark;
  for (int i = 0; i < 40; ++i)
    dark = NextExposure(sheet, dark, Picture(kValues, 0)), bright = NextExposure(sheet, bright, Picture(kValues, 255));
  EXPECT_EQ(dark.exposure_s, sheet.exposure_max_s);
  EXPECT_EQ(dark.gain, sheet.gain_max);
  EXPECT_EQ(bright.exposure_s, sheet.exposure_min_s);
  EXPECT_EQ(bright.gain, 1.0);
  EXPECT_EQ(NextExposure(sheet, DefaultSettings(sheet), Picture(kValues, 118)),
            DefaultSettings(sheet));  // linear 0.181
}

}  // namespace
}  // namespace merlin::sim
