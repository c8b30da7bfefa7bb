// Simple scenes whose phases can be added up by hand.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/tof/stage.h"

namespace merlin::sim {
namespace {

const double kUnambiguous_m = UnambiguousRange_m(20e6);

TEST(TofCamera, ReadsTheTruthWithoutEffects) {
  for (const double x_m : {0.3, 1.0, 3.0, 7.0}) {
    const Stage stage({Wall(x_m)});
    const DepthFrame frame = stage.Expose("ideal");
    const DepthCameraSheet sheet = Sheet3kS();
    for (int v = 0; v < 48; v += 7) {
      for (int u = 0; u < 64; u += 9) {
        // By hand: the ray (x, y, 1) / n meets the plane z = d at range d n under the angle with cosine 1 / n.
        const double x = (u - 31.5) / sheet.camera.fx_px, y = (v - 23.5) / sheet.camera.fy_px;
        const double n = std::sqrt(1 + x * x + y * y);
        EXPECT_NEAR(std::remainder(frame.range_m[Pixel(u, v)] - x_m * n, kUnambiguous_m), 0.0, 5e-6) << x_m;
        const double signal_e = 2000.0 * 1000.0 * 0.5 / n / (x_m * x_m * n * n);
        EXPECT_NEAR(frame.amplitude[Pixel(u, v)] / (0.45 * signal_e), 1.0, 1e-5);
        EXPECT_EQ(frame.flags[Pixel(u, v)], 0);
      }
    }
  }
}

TEST(TofCamera, ReadsAWallAtNineMetresAt1505) {
  DepthCameraSheet sheet = Sheet3kS();
  sheet.camera = {.width = 1, .height = 1, .fx_px = 100, .fy_px = 100, .cx_px = 0, .cy_px = 0};
  const Stage stage({Wall(9.0)});
  const DepthFrame frame = stage.Expose("ideal", {}, {}, sheet);
  EXPECT_NEAR(frame.range_m[0], 1.505, 0.5e-3);
  EXPECT_NEAR(frame.amplitude[0], 0.45 * 1e6 / 81.0, 0.1);
  EXPECT_NEAR(stage.Expose("ideal", {.second_frequency_hz = 30e6}, {}, sheet).range_m[0], 9.0, 1e-4);
}

TEST(TofCamera, SaysThatNothingCameBackFromEmptySpace) {
  const Stage stage({{{-5, 0, 0}, {1, 1, 1}}});
  for (const char* effects : {"ideal", "all"}) {
    const DepthFrame frame = stage.Expose(effects);
    for (std::size_t i = 0; i < frame.size(); ++i) {
      ASSERT_TRUE(frame.flags[i] & kInvalid) << effects;
      ASSERT_EQ(frame.range_m[i], 0.0f);
    }
  }
}

TEST(TofEnergy, TwiceTheLightDoublesAmplitudeAndKeepsPhase) {
  for (const char* effects : {"ideal", "flying,multipath,scatter,lamp,wiggling"}) {
    const DepthFrame once = Stage({Wall(2.345, 0.3)}).Expose(effects);
    const DepthFrame longer = Stage({Wall(2.345, 0.3)}).Expose(effects, {.integration_s = 2e-3});
    const DepthFrame brighter = Stage({Wall(2.345, 0.6)}).Expose(effects);
    for (std::size_t i = 0; i < once.size(); i += 37) {
      EXPECT_NEAR(longer.amplitude[i] / once.amplitude[i], 2.0, 1e-4) << effects;
      EXPECT_NEAR(longer.range_m[i], once.range_m[i], 1e-4) << effects;
      EXPECT_NEAR(brighter.amplitude[i] / once.amplitude[i], 2.0, 1e-4) << effects;
      EXPECT_NEAR(brighter.range_m[i], once.range_m[i], 1e-4) << effects;  // a flat wall: nothing bounces
    }
  }
}

// Many periods away the light stays constant while the wall moves, and only the phase changes.
TEST(TofMotion, ErrsAxiallyByHalfTheMotionInASubFrameTimesCos2Phi) {
  constexpr double kSpeed_m_s = 2.0;
  const DepthSettings settings{.integration_s = 4e-3};
  const double step_m = kSpeed_m_s * (4e-3 + 1e-3);
  DepthCameraSheet sheet = Sheet3kS();
  sheet.camera = {.width = 1, .height = 1, .fx_px = 100, .fy_px = 100, .cx_px = 0, .cy_px = 0};
  for (double past_m = 0.0; past_m < kUnambiguous_m; past_m += 0.3) {
    const double x_m = 11.0 * kUnambiguous_m + past_m;
    for (const double sign : {1.0, -1.0}) {
      Stage stage({Wall(x_m)});
      stage.camera.velocity_m_s = {-sign * kSpeed_m_s, 0, 0};  // 1: the range grows
      const double error_m =
          std::remainder(stage.Expose("motion", settings, {}, sheet).range_m[0] - x_m, kUnambiguous_m);
      const double law_m = sign * 0.5 * step_m * std::cos(2.0 * WaveNumber(20e6) * x_m);
      EXPECT_NEAR(error_m, law_m, 0.1 * 0.5 * step_m) << x_m;
    }
  }
}

// Nearby, the light of the four sub-frames differs as well. The four taps are written out, with N ~ 1 / d^2 and
// averaged over the integration.
TEST(TofMotion, AddsTheChangeOfLightNearBy) {
  const DepthSettings settings{.integration_s = 4e-3};
  DepthCameraSheet sheet = Sheet3kS();
  sheet.camera = {.width = 1, .height = 1, .fx_px = 100, .fy_px = 100, .cx_px = 0, .cy_px = 0};
  for (double x_m = 0.5; x_m < 6.0; x_m += 0.5) {
    double D[4] = {};
    for (int k = 0; k < 4; ++k) {
      for (int i = 0; i < 100; ++i) {
        const double d = x_m + 1.5 * ((k - 1.5) * 5e-3 + 4e-3 * ((i + 0.5) / 100 - 0.5));
        D[k] += std::cos(WaveNumber(20e6) * d + k * kPi / 2) / (d * d);
      }
    }
    double range_m = std::atan2(D[3] - D[1], D[0] - D[2]) / WaveNumber(20e6);
    Stage stage({Wall(x_m)});
    stage.camera.velocity_m_s = {-1.5, 0, 0};
    EXPECT_NEAR(std::remainder(stage.Expose("motion", settings, {}, sheet).range_m[0] - range_m, kUnambiguous_m), 0.0,
                2e-4)
        << x_m;
  }
}

// The camera moves sideways past an edge. The sub-frames see different depths, and the flag reports it.
TEST(TofMotion, FlagsPixelsThatAnEdgePasses) {
  Stage stage({Wall(4.0, 0.8), {{1.05, -5.0, 0}, {0.1, 10.0, 10.0}, {.nir_albedo = 0.8}}});
  const auto flagged = [&stage] {
    const DepthFrame frame = stage.Expose("motion,flying,noise");
    return std::ranges::count_if(frame.flags, [](std::uint8_t flags) { return (flags & kInconsistent) != 0; });
  };
  EXPECT_EQ(flagged(), 0);
  stage.camera.velocity_m_s = {0, 2.0, 0};  // 1.4 pixels of the near edge in a frame
  EXPECT_GT(flagged(), 20);
}

// A box's vertical edge in the middle of a wall, seen by a camera that moves sideways past it.
std::vector<float> EdgeSweep(double near_m, double far_m, std::vector<double>* shares) {
  std::vector<float> ranges;
  const double pixel_m = near_m / Sheet3kS().camera.fx_px;
  for (int step = -9; step <= 9; ++step) {
    // The edge runs through pixel 32, whose middle looks half a pixel to the right (-y).
    const double edge_y_m = -0.5 * pixel_m + (step + 0.5) / 12.0 * pixel_m;
    const Stage stage({Wall(far_m), {{near_m + 1e-5, edge_y_m - 5.0, 0}, {2e-5, 10.0, 10.0}}});
    ranges.push_back(stage.Expose("flying").range_m[Pixel(32, 24)]);
    int seen = 0;  // of three columns of sub-rays at -1/3, 0, 1/3 of a pixel
    for (const double off : {-1.0, 0.0, 1.0}) seen += -0.5 * pixel_m - off / 3.0 * pixel_m < edge_y_m;
    shares->push_back(seen / 3.0);
  }
  return ranges;
}

TEST(TofFlyingPixels, MixTwoSurfacesAsTheirPhasorsDo) {
  constexpr double kNear_m = 1.0;
  for (const double apart_m : {0.5, 1.0, 3.0, 5.0}) {
    std::vector<double> shares;
    const std::vector<float> ranges = EdgeSweep(kNear_m, kNear_m + apart_m, &shares);
    const DepthCameraSheet sheet = Sheet3kS();
    const double x = 0.5 / sheet.camera.fx_px, y = 0.5 / sheet.camera.fy_px, n = std::sqrt(1 + x * x + y * y);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const double far_m = kNear_m + apart_m, a = shares[i];
      const double mixed_m =
          RangeOfWays({{a / (kNear_m * kNear_m), kNear_m * n}, {(1 - a) / (far_m * far_m), far_m * n}}, 0.0);
      EXPECT_NEAR(std::remainder(ranges[i] - mixed_m, kUnambiguous_m), 0.0, 2e-3) << apart_m << " m, share " << a;
    }
    if (apart_m < kUnambiguous_m / 2.0) {  // between the two, and never back
      for (std::size_t i = 1; i < ranges.size(); ++i) EXPECT_LE(ranges[i], ranges[i - 1] + 1e-4) << apart_m;
      EXPECT_NEAR(ranges.front(), (kNear_m + apart_m) * n, 1e-3);
      EXPECT_NEAR(ranges.back(), kNear_m * n, 1e-3);
    }
  }
}

TEST(TofFlyingPixels, GoTheOtherWayRoundBeyondHalfTheUnambiguousRange) {
  std::vector<double> shares;
  // Equal shares of light: a far wall 36 times as bright would be needed at 6 m; near enough with the share at 1/3.
  const std::vector<float> ranges = EdgeSweep(1.0, 6.0, &shares);
  bool outside = false;
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (shares[i] > 0.0 && shares[i] < 1.0) outside |= ranges[i] < 1.0 - 1e-3 || ranges[i] > 6.0 + 1e-2;
  EXPECT_TRUE(outside);
}

TEST(TofFlyingPixels, DimMostWhereTheSurfacesAreHalfTheRangeApart) {
  std::vector<double> amplitudes;
  for (const double apart_m : {0.5, 2.0, kUnambiguous_m / 2.0, 6.0}) {
    // Albedos that make both sides equally bright; the edge through the middle of pixel 32 leaves one column on it.
    const double far_m = 1.0 + apart_m, pixel_m = 1.0 / Sheet3kS().camera.fx_px;
    const Stage stage({Wall(far_m, 0.01 * far_m * far_m),
                       {{1.00001, -0.5 * pixel_m + 1e-4 - 5.0, 0}, {2e-5, 10.0, 10.0}, {.nir_albedo = 0.01}}});
    amplitudes.push_back(stage.Expose("flying").amplitude[Pixel(32, 24)]);
  }
  EXPECT_EQ(std::ranges::min_element(amplitudes) - amplitudes.begin(), 2);
  // |N1 - N2| with two columns of three on one side.
  EXPECT_NEAR(amplitudes[2], 0.45 * 2e6 * 0.01 / 3.0, 0.05 * 0.45 * 2e6 * 0.01 / 3.0);
}

TEST(TofIntensity, DarkSquaresReadNearerThanBrightOnes) {
  const struct { double x_m, integration_s; } cases[] = {{1.0, 1e-4}, {1.5, 2e-4}, {2.0, 3e-4}};
  for (const auto& [x_m, integration_s] : cases) {
    const Stage stage({Wall(x_m, 0.9), {{x_m, 0, 0}, {2e-4, 0.2 * x_m, 2.0}, {.nir_albedo = 0.1}}});
    const DepthFrame frame = stage.Expose("intensity,saturation", {.integration_s = integration_s});
    const double step_m = frame.range_m[Pixel(8, 24)] / std::hypot(1.0, 23.5 / 87.918, 0.5 / 89.57) -
                          frame.range_m[Pixel(32, 24)] / std::hypot(1.0, 0.5 / 87.918, 0.5 / 89.57);
    EXPECT_GT(step_m, 0.010) << x_m;
    EXPECT_LT(step_m, 0.050) << x_m;
  }
}

// Thesis figure 4.13: at 100 us a near book is usable and a far chair is not; at 5 ms it is the other way round.
TEST(TofIntegration, ExposesEitherTheNearBookOrTheFarChair) {
  const Stage book({Wall(0.6, 0.7)}), chair({Wall(3.8, 0.4)});
  const auto sigma_m = [](const Stage& stage, double integration_s) {
    const TofCamera camera(Sheet3kS(), {}, ParseTofEffects("noise,saturation,adc"), 1);
    double squares = 0.0, sum = 0.0;
    int n = 0, saturated = 0;
    for (std::uint64_t i = 0; i < 40; ++i) {
      const DepthFrame frame = camera.Expose(stage.view(), {.integration_s = integration_s}, Time{0}, i);
      for (int u = 28; u < 36; ++u) {
        const float range_m = frame.range_m[Pixel(u, 24)];
        sum += range_m, squares += range_m * range_m, ++n;
        saturated += (frame.flags[Pixel(u, 24)] & kSaturated) != 0;
      }
    }
    return saturated > n / 2 ? HUGE_VAL : std::sqrt(squares / n - sum * sum / n / n);
  };
  EXPECT_LT(sigma_m(book, 1e-4), 0.010);
  EXPECT_GT(sigma_m(chair, 1e-4), 0.050);
  EXPECT_EQ(sigma_m(book, 5e-3), HUGE_VAL);  // saturated
  EXPECT_LT(sigma_m(chair, 5e-3), 0.010);
}

TEST(TofCamera, TakesTheSameFrameWithAnyNumberOfThreads) {
  Stage stage(
      {Wall(4.0), {{2.0, 0.5, 0}, {0.5, 0.5, 0.5}}, {{3.0, -1.0, 0}, {0.01, 1.0, 1.0}, {.glass_transmission = 0.9}}});
  stage.camera.velocity_m_s = {0.5, 0.1, 0};
  stage.camera.angular_velocity_rad_s = {0, 0, 0.3};
  stage.around.sun = Sun{.to_sun = Eigen::Vector3d(-1, 1, 1).normalized()};
  const auto expose = [&stage](int threads) {
    return TofCamera(Sheet3kS(), {.lamp_baseline_m = 0.08}, {}, 1, threads)
        .Expose(stage.view(), {.second_frequency_hz = 30e6, .phase_images = true}, Time{0}, 5);
  };
  const DepthFrame one = expose(1);
  for (const int threads : {2, 3, 7}) {
    const DepthFrame other = expose(threads);
    EXPECT_EQ(one.range_m, other.range_m) << threads;
    EXPECT_EQ(one.amplitude, other.amplitude) << threads;
    EXPECT_EQ(one.intensity, other.intensity) << threads;
    EXPECT_EQ(one.flags, other.flags) << threads;
    EXPECT_EQ(one.phase_images, other.phase_images) << threads;
  }
}

}  // namespace
}  // namespace merlin::sim
