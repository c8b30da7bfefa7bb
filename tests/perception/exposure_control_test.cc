#include "perception/exposure_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/pmd_3k.h"

namespace merlin {
namespace {

constexpr double kDepthRate_hz = 20.0;
constexpr int kWidth = 40, kHeight = 10;

DepthCameraSheet BoxSheet() {
  return ExposingPmd3k({.width = kWidth, .height = kHeight, .fx_px = 50, .fy_px = 50, .cx_px = 19.5, .cy_px = 4.5});
}

// The camera's law: a surface of albedo 0.5 collects 1000 e T [us] / d^2, and the fuller tap holds 0.725 of that.
bool Saturates(double distance_m, double integration_s) {
  return 0.725 * 1000.0 * integration_s * 1e6 / (distance_m * distance_m) > 1.5e6;
}

// A box that fills a fifth of the picture, in front of a wall. Distance 0: no box.
DepthFrame Seen(double box_m, double wall_m, double integration_s, double time_s) {
  DepthFrame frame;
  frame.stamp = FromSeconds(time_s);
  frame.settings.integration_s = integration_s;
  frame.width = kWidth;
  frame.height = kHeight;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const double range_m = box_m > 0.0 && i % 5 == 0 ? box_m : wall_m;
    const bool full = Saturates(range_m, integration_s);
    frame.range_m.push_back(static_cast<float>(range_m));
    frame.amplitude.push_back(
        static_cast<float>(full ? 5e5 : 450.0 * integration_s * 1e6 / (range_m * range_m)));  // a wrong one where full
    frame.flags.push_back(full ? kSaturated : 0);
    frame.intensity.push_back(0);
  }
  return frame;
}

struct Series {
  std::vector<double> exposures_s;  // of the frames
  bool box_measured = false;        // the box was measured in the last second
};

// A camera whose new settings hold from the second-next exposure on, as those of the twin do at 20 Hz.
Series Drive(double box_m, double wall_m, double begin_s, bool automatic, int frames = 100) {
  ExposureControl control(BoxSheet(), kDepthRate_hz, {.automatic = automatic});
  double now_s = begin_s, next_s = begin_s;
  Series run;
  for (int i = 0; i < frames; ++i) {
    const DepthFrame frame = Seen(box_m, wall_m, now_s, i / kDepthRate_hz);
    run.exposures_s.push_back(now_s);
    if (i >= frames - 20) run.box_measured |= box_m > 0.0 && !Saturates(box_m, now_s);
    now_s = next_s;
    next_s = control.After(frame).integration_s;
    EXPECT_GE(next_s, 100e-6);
    EXPECT_LE(next_s, automatic ? 5000e-6 : begin_s);
  }
  return run;
}

TEST(ExposureControl, KeepsAFixedExposureWhereNothingSaturates) {
  for (const double exposure_s : Drive(0.0, 3.0, 1e-3, false).exposures_s) EXPECT_EQ(exposure_s, 1e-3);
}

TEST(ExposureControl, MeasuresWhatSaturatesWithEveryOtherFrame) {
  for (const double box_m : {1.0, 0.5, 0.3}) {  // at 5 ms what is nearer than 1.55 m saturates
    const Series run = Drive(box_m, 4.0, 5e-3, false);
    EXPECT_TRUE(run.box_measured) << box_m;
    EXPECT_EQ(std::ranges::count(run.exposures_s.end() - 20, run.exposures_s.end(), 5e-3), 10) << box_m;
  }
}

TEST(ExposureControl, GoesDownToTheShortestForASurfaceTooNearForIt) {
  const Series run = Drive(0.05, 4.0, 5e-3, false);
  EXPECT_FALSE(run.box_measured);
  EXPECT_EQ(std::ranges::min(run.exposures_s), 100e-6);
}

TEST(ExposureControl, HasNoShorterOneThanTheShortest) {
  for (const double exposure_s : Drive(0.05, 4.0, 100e-6, false).exposures_s) EXPECT_EQ(exposure_s, 100e-6);
}

TEST(ExposureControl, StopsAlternatingOnceNothingSaturates) {
  ExposureControl control(BoxSheet(), kDepthRate_hz, {});
  double next_s = 5e-3;
  for (int i = 0; i < 10; ++i) next_s = control.After(Seen(0.8, 4.0, next_s, i / kDepthRate_hz)).integration_s;
  int shorter = 0;
  for (int i = 10; i < 80; ++i) {
    next_s = control.After(Seen(0.0, 4.0, next_s, i / kDepthRate_hz)).integration_s;
    shorter += next_s < 5e-3;
    if (i > 10 + 25) {
      EXPECT_EQ(next_s, 5e-3) << i;
    }
  }
  EXPECT_GT(shorter, 5);
}

TEST(ExposureControl, IgnoresTheFewPixelsThatAreAlwaysFull) {
  ExposureControl control(BoxSheet(), kDepthRate_hz, {});
  DepthFrame frame = Seen(0.0, 4.0, 1e-3, 0.0);
  frame.flags[17] = kSaturated;  // 1 of 400
  EXPECT_EQ(control.After(frame).integration_s, 1e-3);
}

TEST(ExposureControl, MeasuresNearAndFarWhenAutomatic) {
  const Series run = Drive(0.4, 6.0, 1e-3, true);
  EXPECT_TRUE(run.box_measured);
  EXPECT_GT(std::ranges::max(run.exposures_s), 4.0 * std::ranges::min(run.exposures_s));
}

TEST(ExposureControl, GivesAnEmptyFrameTheSettingsItHad) {
  ExposureControl control(BoxSheet(), kDepthRate_hz, {.automatic = true});
  DepthFrame frame;
  frame.settings.integration_s = 7e-4;
  EXPECT_EQ(control.After(frame).integration_s, 7e-4);
}

// K T 0.8 (1 + C) / 2 = full well: T = 1.5e6 / (2000 * 0.8 * 0.725) us at 20 MHz.
TEST(StartIntegration, FillsTheWellWithAWhiteWallAtOneMetre) {
  EXPECT_NEAR(StartIntegration_s(BoxSheet(), {}, kDepthRate_hz), 1293.1e-6, 0.1e-6);
  DepthCameraSheet bright = BoxSheet();
  bright.signal_e_m2_per_us = 1e6;
  EXPECT_EQ(StartIntegration_s(bright, {}, kDepthRate_hz), 100e-6);
  EXPECT_NEAR(StartIntegration_s(BoxSheet(), {.second_frequency_hz = 30e6}, 100.0), 0.25e-3, 1e-12);  // eight fit 10 ms
}

}  // namespace
}  // namespace merlin
