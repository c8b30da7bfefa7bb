#include "perception/integration_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/pmd_3k.h"

namespace merlin {
namespace {

constexpr double kRate_hz = 20.0;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// At 20 MHz of contrast 0.45 an amplitude of 2 * 0.45 / 1.45 * 1.5e6 = 931,034 e just fills the fuller tap.
constexpr double kFullAmplitude_e = 931034.48;

DepthCameraSheet LobeSheet() {
  return ExposingPmd3k({.width = 16, .height = 12, .fx_px = 22, .fy_px = 22, .cx_px = 7.5, .cy_px = 5.5});
}

// A facing wall, darker towards the picture's edge (down to a third). The camera's own law: signal ~ T / d^2.
DepthFrame LobeWall(double distance_m, double albedo, const DepthSettings& settings) {
  const DepthCameraSheet sheet = LobeSheet();
  DepthFrame frame;
  frame.settings = settings;
  frame.width = sheet.camera.width;
  frame.height = sheet.camera.height;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const double lobe = std::exp(-std::log(3.0) * (std::pow(u - 7.5, 2) + std::pow(v - 5.5, 2)) / 86.5);
      const double signal_e = 2000.0 * albedo * lobe * settings.integration_s * 1e6 / (distance_m * distance_m);
      const double amplitude_e = 0.45 * signal_e;
      frame.range_m.push_back(static_cast<float>(distance_m));
      frame.amplitude.push_back(
          static_cast<float>(std::min(amplitude_e, 0.7 * kFullAmplitude_e)));  // clipped: a wrong one
      frame.intensity.push_back(0);
      frame.flags.push_back(signal_e * 1.45 / 2.0 > 1.5e6 ? kSaturated : amplitude_e < 600.0 ? kLowSignal : 0);
    }
  }
  return frame;
}

DepthFrame Even(double amplitude_e, std::uint8_t flags, double integration_s) {
  DepthFrame frame;
  frame.settings.integration_s = integration_s;
  frame.width = 4;
  frame.height = 2;
  frame.range_m.assign(8, 2.0f);
  frame.amplitude.assign(8, static_cast<float>(amplitude_e));
  frame.intensity.assign(8, 0);
  frame.flags.assign(8, flags);
  return frame;
}

DepthFrame Empty(double integration_s) {
  DepthFrame frame;
  frame.settings.integration_s = integration_s;
  return frame;
}

double MeanAmplitude_e(const DepthFrame& frame) {
  double sum_e = 0.0;
  for (const float amplitude_e : frame.amplitude) sum_e += amplitude_e;
  return sum_e / static_cast<double>(frame.size());
}

bool AnySaturated(const DepthFrame& frame) {
  return std::ranges::any_of(frame.flags, [](std::uint8_t flags) { return (flags & kSaturated) != 0; });
}

// The frame after some frames of adaptation. Every integration time on the way must be valid.
DepthFrame Settled(double distance_m, double albedo, double begin_s, int frames, const IntegrationConfig& config = {}) {
  DepthSettings settings{.integration_s = begin_s};
  for (int i = 0; i < frames; ++i) {
    settings = Adapt(LobeWall(distance_m, albedo, settings), LobeSheet(), kRate_hz, config);
    EXPECT_GE(settings.integration_s, 100e-6);
    EXPECT_LE(settings.integration_s, 5000e-6);
  }
  return LobeWall(distance_m, albedo, settings);
}

TEST(IntegrationTime, ShrinksBeforeANearWallUntilNothingSaturates) {
  for (const double distance_m : {0.5, 0.7, 1.0, 1.5}) {
    EXPECT_TRUE(AnySaturated(LobeWall(distance_m, 0.8, {.integration_s = 5000e-6}))) << distance_m;
    EXPECT_FALSE(AnySaturated(Settled(distance_m, 0.8, 5000e-6, 12))) << distance_m;
  }
}

TEST(IntegrationTime, EndsAtTheShortestBeforeAWallTooNearForIt) {
  EXPECT_EQ(Settled(0.05, 0.8, 5000e-6, 12).settings.integration_s, 100e-6);
}

TEST(IntegrationTime, GrowsBeforeAFarWall) {
  const DepthFrame dark = LobeWall(4.0, 0.5, {.integration_s = 100e-6});
  const DepthFrame settled = Settled(4.0, 0.5, 100e-6, 12);
  EXPECT_GT(settled.settings.integration_s, 20.0 * dark.settings.integration_s);
  EXPECT_EQ(Settled(7.0, 0.1, 100e-6, 12).settings.integration_s, 5000e-6);  // never bright enough
}

TEST(IntegrationTime, ReachesTheTargetFromEitherSideAndStays) {
  const IntegrationConfig config;
  for (const double distance_m : {0.6, 0.8, 1.5, 2.5})
    for (const double begin_s : {100e-6, 1000e-6, 5000e-6}) {
      const DepthFrame settled = Settled(distance_m, 0.6, begin_s, 14);
      EXPECT_NEAR(MeanAmplitude_e(settled) / kFullAmplitude_e, config.target_share,
                  config.dead_band * config.target_share)
          << distance_m << " m from " << begin_s;
      EXPECT_EQ(Settled(distance_m, 0.6, begin_s, 15).settings.integration_s, settled.settings.integration_s);
    }
}

TEST(IntegrationTime, StepIsWiedemannsRuleWithinItsLimit) {
  const IntegrationConfig config{.target_share = 0.2};
  const auto step = [&](double share) {
    return Adapt(Even(share * kFullAmplitude_e, 0, 1e-3), LobeSheet(), kRate_hz, config).integration_s / 1e-3;
  };
  EXPECT_NEAR(step(0.15), 1.25, 1e-6);  // dev = (0.20 - 0.15) / 0.20
  EXPECT_NEAR(step(0.25), 0.75, 1e-6);
  EXPECT_EQ(step(0.19), 1.0);  // in the dead band
  EXPECT_NEAR(step(0.0), 1.5, 1e-12);
  EXPECT_NEAR(step(0.9), 0.5, 1e-12);
}

TEST(IntegrationTime, AFewSaturatedPixelsPullDown) {
  DepthFrame frame = Even(0.19 * kFullAmplitude_e, 0, 1e-3);
  frame.flags[3] = kSaturated;
  EXPECT_LT(Adapt(frame, LobeSheet(), kRate_hz, {}).integration_s, 1e-3);
}

TEST(IntegrationTime, KeepsTheTimeWithoutAUsablePixel) {
  EXPECT_EQ(Adapt(Empty(7e-4), LobeSheet(), kRate_hz, {}).integration_s, 7e-4);
  EXPECT_EQ(Adapt(Even(kNaN, 0, 7e-4), LobeSheet(), kRate_hz, {}).integration_s, 7e-4);
  EXPECT_EQ(Adapt(Even(0.0, kInvalid, 7e-4), LobeSheet(), kRate_hz, {}).integration_s, 7e-4);
  EXPECT_EQ(Adapt(Even(1e9, kInconsistent, 7e-4), LobeSheet(), kRate_hz, {}).integration_s, 7e-4);
}

TEST(IntegrationTime, LeavesOutPixelsThatAreNoNumbers) {
  DepthFrame frame = Even(0.2 * kFullAmplitude_e, 0, 1e-3);
  frame.amplitude[0] = static_cast<float>(kNaN);
  frame.amplitude[1] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(Adapt(frame, LobeSheet(), kRate_hz, {}).integration_s, 1e-3);
}

TEST(IntegrationTime, DarkPixelsThatTheMakersFilterDroppedStillAskForLight) {
  EXPECT_GT(Adapt(Even(10.0, kLowSignal | kInvalid, 1e-3), LobeSheet(), kRate_hz, {}).integration_s, 1e-3);
}

TEST(IntegrationTime, LetsTheFrameEndWithinItsPeriod) {
  // 100 Hz: four sub-frames of 10 ms in all, 1 ms of read-out each; with two frequencies eight, 0.25 ms each.
  EXPECT_NEAR(Adapt(Even(10.0, 0, 1.4e-3), LobeSheet(), 100.0, {}).integration_s, 1.5e-3, 1e-12);
  DepthFrame two = Even(10.0, 0, 0.2e-3);
  two.settings.second_frequency_hz = 30e6;
  EXPECT_NEAR(Adapt(two, LobeSheet(), 100.0, {}).integration_s, 0.25e-3, 1e-12);
  EXPECT_EQ(Adapt(two, LobeSheet(), 1000.0, {}).integration_s, 100e-6);  // nothing fits: the shortest
}

TEST(IntegrationTime, ChangesNothingElse) {
  DepthFrame frame = Even(10.0, 0, 1e-3);
  frame.settings = {.integration_s = 1e-3,
                    .frequency_hz = 30e6,
                    .second_frequency_hz = 20e6,
                    .post_processing = true,
                    .phase_images = true};
  const DepthSettings adapted = Adapt(frame, LobeSheet(), 5.0, {});
  EXPECT_GT(adapted.integration_s, 1e-3);
  EXPECT_EQ(adapted.frequency_hz, 30e6);
  EXPECT_EQ(adapted.second_frequency_hz, 20e6);
  EXPECT_TRUE(adapted.post_processing);
  EXPECT_TRUE(adapted.phase_images);
}

}  // namespace
}  // namespace merlin
