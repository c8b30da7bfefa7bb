#include "perception/filter/depth_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace merlin {
namespace {

// A sheet with round numbers: at 1 ms and 20 MHz a facing surface of albedo 1 at 1 m gives 900,000 e.
DepthCameraSheet Sheet() {
  DepthCameraSheet sheet;
  sheet.camera = {.width = 16, .height = 12, .fx_px = 22, .fy_px = 22, .cx_px = 7.5, .cy_px = 5.5};
  sheet.signal_e_m2_per_us = 2000.0;
  sheet.contrast_at_20mhz = 0.45;
  sheet.contrast_corner_hz = 30e6;
  sheet.read_noise_e = 200.0;
  return sheet;
}

// The range, wrapped, that a camera reads of a facing wall at a true distance.
DepthFrame Wall(double distance_m, double albedo) {
  const DepthCameraSheet sheet = Sheet();
  DepthFrame frame;
  frame.width = sheet.camera.width;
  frame.height = sheet.camera.height;
  const std::size_t n = static_cast<std::size_t>(frame.width) * frame.height;
  frame.range_m.assign(n, static_cast<float>(std::fmod(distance_m, UnambiguousRange_m(20e6))));
  frame.amplitude.assign(n, static_cast<float>(900'000.0 * albedo / (distance_m * distance_m)));
  frame.intensity.assign(n, 0);
  frame.flags.assign(n, 0);
  return frame;
}

int Count(const FilteredDepth& depth, Rejection reason) { return depth.counts[static_cast<std::size_t>(reason)]; }

TEST(DepthFilter, KeepsAFacingWallUntouched) {
  const FilteredDepth depth = FilterDepth(Wall(3.0, 0.5), Sheet(), {});
  EXPECT_EQ(Count(depth, Rejection::kNone), 16 * 12);
  for (const float range_m : depth.frame.range_m) EXPECT_FLOAT_EQ(range_m, 3.0f);
}

TEST(DepthFilter, RejectsWallsThatWrapAsGhosts) {
  for (const double distance_m : {7.6, 8.0, 9.0, 9.5, 10.0, 12.0, 14.0, 17.0, 22.0})
    for (const double albedo : {0.1, 0.35, 0.8, 0.89})
      EXPECT_EQ(Count(FilterDepth(Wall(distance_m, albedo), Sheet(), {}), Rejection::kGhost), 16 * 12)
          << distance_m << " m, albedo " << albedo;
}

// 20 and 30 MHz: unambiguous to 14.990 m, the range their common divisor of 10 MHz wraps at.
TEST(DepthFilter, WithTwoFrequenciesKeepsWhatOneWouldCallAGhost) {
  const auto reasons = [](double distance_m, double albedo, double second_frequency_hz) {
    DepthFrame frame = Wall(distance_m, albedo);
    frame.settings.second_frequency_hz = second_frequency_hz;
    if (second_frequency_hz > 0.0)
      std::ranges::fill(frame.range_m, static_cast<float>(std::fmod(distance_m, kSpeedOfLight_m_s / 20e6)));
    return FilterDepth(frame, Sheet(), {});
  };
  for (const double albedo : {0.15, 0.35, 0.8}) {
    for (const double distance_m : {7.6, 9.0, 10.0, 14.0})
      EXPECT_EQ(Count(reasons(distance_m, albedo, 0.0), Rejection::kGhost), 16 * 12) << distance_m;
    for (const double distance_m : {1.0, 3.0})
      EXPECT_EQ(Count(reasons(distance_m, albedo, 30e6), Rejection::kNone), 16 * 12) << distance_m;
    for (const double distance_m : {15.1, 16.0, 20.0, 29.0, 31.0})
      EXPECT_EQ(Count(reasons(distance_m, albedo, 30e6), Rejection::kGhost), 16 * 12) << distance_m;
  }
  for (const double distance_m : {7.6, 9.0, 10.0, 14.0})
    EXPECT_EQ(Count(reasons(distance_m, 0.8, 30e6), Rejection::kNone), 16 * 12) << distance_m;
}

TEST(DepthFilter, KeepsADarkFacingBoxWithinThreeMetres) {
  for (const double distance_m : {0.3, 0.6, 1.0, 2.0, 2.5, 3.0})
    EXPECT_EQ(Count(FilterDepth(Wall(distance_m, 0.1), Sheet(), {}), Rejection::kNone), 16 * 12) << distance_m << " m";
}

TEST(DepthFilter, KeepsAReasonForEveryFlag) {
  DepthFrame frame = Wall(3.0, 0.5);
  frame.flags[0] = kInvalid;
  frame.flags[1] = kSaturated;
  frame.flags[2] = kInconsistent;
  frame.flags[3] = kLowSignal;
  frame.range_m[4] = std::numeric_limits<float>::quiet_NaN();
  frame.range_m[5] = 0.0f;
  frame.flags[6] = kSbiActive;  // not a fault
  const FilteredDepth depth = FilterDepth(frame, Sheet(), {});
  EXPECT_EQ(depth.reasons[0], Rejection::kInvalid);
  EXPECT_EQ(depth.reasons[1], Rejection::kSaturated);
  EXPECT_EQ(depth.reasons[2], Rejection::kInconsistent);
  EXPECT_EQ(depth.reasons[3], Rejection::kLowSignal);
  EXPECT_EQ(depth.reasons[4], Rejection::kInvalid);
  EXPECT_EQ(depth.reasons[5], Rejection::kInvalid);
  EXPECT_EQ(depth.reasons[6], Rejection::kNone);
}

TEST(DepthFilter, RejectsALonelyPixelAndMendsSmallNoiseByTheMedian) {
  DepthFrame frame = Wall(3.0, 0.5);
  const std::size_t lonely = 5 * 16 + 7, noisy = 8 * 16 + 3;
  frame.range_m[lonely] = 1.0f;
  frame.amplitude[lonely] *= 9.0f;  // as bright as its range implies
  frame.range_m[noisy] = 3.1f;
  const FilteredDepth depth = FilterDepth(frame, Sheet(), {});
  EXPECT_EQ(depth.reasons[lonely], Rejection::kLonely);
  EXPECT_EQ(depth.reasons[noisy], Rejection::kNone);
  EXPECT_FLOAT_EQ(depth.frame.range_m[noisy], 3.0f);
}

TEST(DepthFilter, KeepsBothSidesOfADepthEdge) {
  DepthFrame frame = Wall(4.0, 0.5);
  for (int v = 0; v < 12; ++v)
    for (int u = 0; u < 8; ++u) frame.range_m[v * 16 + u] = 2.0f, frame.amplitude[v * 16 + u] *= 4.0f;
  const FilteredDepth depth = FilterDepth(frame, Sheet(), {});
  EXPECT_EQ(Count(depth, Rejection::kNone), 16 * 12);
  EXPECT_FLOAT_EQ(depth.frame.range_m[5 * 16 + 7], 2.0f);
  EXPECT_FLOAT_EQ(depth.frame.range_m[5 * 16 + 8], 4.0f);
}

TEST(DepthFilter, TakesAnEmptyFrame) {
  const FilteredDepth depth = FilterDepth(DepthFrame{}, Sheet(), {});
  EXPECT_TRUE(depth.reasons.empty());
}

TEST(Ghost, ANaNIsAGhost) { EXPECT_TRUE(IsGhost(std::nan(""), 1e4, 9e5, 7.5, 0.9)); }

}  // namespace
}  // namespace merlin
