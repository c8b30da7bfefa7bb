#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <ranges>

#include "robot/types/error.h"
#include "sim/tof/tof_camera.h"

namespace merlin::sim {
namespace {

constexpr TofEffects kAll{};
constexpr TofEffects kIdeal{.noise = false, .saturation = false};
constexpr TofEffects kNoiseOnly{.noise = true, .saturation = false};
const double kUnambiguous_m = UnambiguousRange_m(20e6);

// A 64x48 PMD camera of 40x30 degrees.
DepthCameraSheet Sheet() {
  DepthCameraSheet sheet;
  sheet.camera = {.width = 64, .height = 48, .fx_px = 87.9, .fy_px = 89.6, .cx_px = 31.5, .cy_px = 23.5};
  sheet.signal_e_m2_per_us = 2000.0;
  sheet.contrast_at_20mhz = 0.45;
  sheet.contrast_corner_hz = 30e6;
  sheet.read_noise_e = 200.0;
  sheet.full_well_e = 1.5e6;
  sheet.low_signal_amplitude_e = 500.0;
  return sheet;
}

// A scene at this range whose pixel collects so many signal electrons.
PixelScene SceneOf(double signal_e, double range_m, const DepthCameraSheet& sheet, const DepthSettings& settings) {
  return {.range_m = range_m,
          .cos_incidence = 1.0,
          .albedo = signal_e * range_m * range_m / (sheet.signal_e_m2_per_us * settings.integration_s * 1e6)};
}

PixelReading Read(const PixelScene& scene, const DepthCameraSheet& sheet, const DepthSettings& settings,
                  const TofEffects& effects, std::uint64_t frame = 0) {
  Random random(1, Sensor::kDepth, frame);
  return DecodePixel(ExposePixel(scene, sheet, settings, effects, random), settings.frequency_hz);
}

struct Statistics {
  double mean = 0.0, sigma = 0.0, outliers = 0.0;
};

// Range errors, shortest way round; outliers: farther than a quarter of the circle.
Statistics RangeErrors(const PixelScene& scene, const DepthCameraSheet& sheet, const DepthSettings& settings,
                       int n = 20000) {
  const double wrap_m = UnambiguousRange_m(settings.frequency_hz);
  double sum = 0.0, squares = 0.0, outliers = 0.0;
  for (int i = 0; i < n; ++i) {
    const PixelReading reading = Read(scene, sheet, settings, kNoiseOnly, static_cast<std::uint64_t>(i));
    const double error = std::remainder(reading.range_m - scene.range_m, wrap_m);
    sum += error;
    squares += error * error;
    outliers += std::abs(error) > wrap_m / 4.0;
  }
  const double mean = sum / n;
  return {.mean = mean, .sigma = std::sqrt(squares / n - mean * mean), .outliers = outliers / n};
}

TEST(TofPixel, ReadsRangeAmplitudeAndIntensityExactlyWithoutNoise) {
  const DepthCameraSheet sheet = Sheet();
  for (const double range_m : {0.001, 0.5, 1.87, 3.0, 3.7474, 5.6, 7.49}) {
    const double signal_e = 2000.0 * 1000.0 * 0.5 * 0.8 / (range_m * range_m);
    const PixelReading reading = Read({range_m, 0.8, 0.5}, sheet, {}, kIdeal);
    EXPECT_NEAR(reading.range_m, range_m, 1e-6);
    EXPECT_NEAR(reading.amplitude / (0.45 * signal_e), 1.0, 1e-6);
    EXPECT_NEAR(reading.intensity / (signal_e / 2.0), 1.0, 1e-6);
  }
}

TEST(TofPixel, TakesTheTapsOfTheFourPhaseAlgorithm) {
  const DepthCameraSheet sheet = Sheet();
  const double range_m = kUnambiguous_m / 8.0;  // phase 45 degrees: m = C N sqrt(1/2) (1, -1, -1, 1)
  Random random(1, Sensor::kDepth, 0);
  const PixelTaps taps = ExposePixel(SceneOf(1000.0, range_m, sheet, {}), sheet, {}, kIdeal, random);
  const double m_e = 450.0 * std::numbers::sqrt2 / 2.0;
  const double sign[4] = {1, -1, -1, 1};
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(taps.a[k], (1000.0 + sign[k] * m_e) / 2.0, 1e-9);
    EXPECT_NEAR(taps.b[k], (1000.0 - sign[k] * m_e) / 2.0, 1e-9);
  }
}

TEST(TofPixel, WrapsAWallAtNineMetres) {
  EXPECT_NEAR(Read({9.0, 1.0, 0.5}, Sheet(), {}, kIdeal).range_m, 1.505, 0.5e-3);
  EXPECT_NEAR(Read({9.0, 1.0, 0.5}, Sheet(), {}, kIdeal).amplitude, 0.45 * 1e6 / 81.0, 0.01);
  EXPECT_NEAR(Read({6.0, 1.0, 0.5}, Sheet(), {.frequency_hz = 30e6}, kIdeal).range_m, 6.0 - 4.99654, 1e-5);
}

TEST(TofPixel, StaysInsideTheUnambiguousRange) {
  const DepthCameraSheet sheet = Sheet();
  EXPECT_EQ(Read({0.0, 1.0, 0.5}, sheet, {}, kIdeal).range_m, 0.0f);
  for (const double off_m : {1e-3, 1e-7, 1e-8, 1e-12, 0.0}) {
    const float range_m = Read({kUnambiguous_m - off_m, 1.0, 0.5}, sheet, {}, kIdeal).range_m;
    EXPECT_GE(range_m, 0.0f);
    EXPECT_LT(range_m, kUnambiguous_m);
    EXPECT_NEAR(std::remainder(range_m + off_m, kUnambiguous_m), 0.0, 1e-6);
  }
  // A phase of -1e-20 rad is 2 pi in double.
  const PixelTaps taps{.a = {1, 0, 0, 0}, .b = {0, 1e-20, 0, 0}};
  EXPECT_LT(DecodePixel({.a = {1, 1e-20, 0, 0}, .b = {}}, 20e6).range_m, kUnambiguous_m);
  EXPECT_GE(DecodePixel(taps, 20e6).range_m, 0.0f);
  EXPECT_EQ(DecodePixel(PixelTaps{}, 20e6).range_m, 0.0f);
}

TEST(TofPixel, DoublesAmplitudeAndKeepsPhaseWithTwiceTheLight) {
  const DepthCameraSheet sheet = Sheet();
  const PixelReading once = Read({2.345, 0.9, 0.3}, sheet, {.integration_s = 1e-3}, kIdeal);
  for (const PixelReading& twice : {Read({2.345, 0.9, 0.6}, sheet, {.integration_s = 1e-3}, kIdeal),
                                    Read({2.345, 0.9, 0.3}, sheet, {.integration_s = 2e-3}, kIdeal)}) {
    EXPECT_NEAR(twice.range_m, once.range_m, 1e-6);
    EXPECT_NEAR(twice.amplitude / once.amplitude, 2.0, 1e-6);
    EXPECT_NEAR(twice.intensity / once.intensity, 2.0, 1e-6);
  }
}

// The law, written out: c / (4 sqrt(2) pi f) sqrt(N + 2 r^2) / (C N).
double Law_m(double signal_e, double contrast, double read_e) {
  return 299792458.0 / (4.0 * std::sqrt(2.0) * std::numbers::pi * 20e6) * std::sqrt(signal_e + 2.0 * read_e * read_e) /
         (contrast * signal_e);
}

TEST(TofNoise, FollowsTheLawOverFiveDecadesOfSignal) {
  DepthCameraSheet sheet = Sheet();
  sheet.contrast_at_20mhz = 0.9;  // keeps the phase error of 60 electrons small (0.1 rad): the law is for small errors
  for (const double read_e : {0.0, 3.0, 20.0}) {
    sheet.read_noise_e = read_e;
    for (const double signal_e : {60.0, 600.0, 6e3, 6e4, 6e5, 6e6}) {
      const double law_m = RangeSigma_m(signal_e, 0.9, read_e, 20e6);
      EXPECT_NEAR(law_m / Law_m(signal_e, 0.9, read_e), 1.0, 1e-12);
      if (law_m > 0.08 * kUnambiguous_m / (2.0 * std::numbers::pi) * 1.5) continue;  // not small
      const double range_m = 1.3 + 0.1 * std::log10(signal_e);
      const Statistics errors = RangeErrors(SceneOf(signal_e, range_m, sheet, {}), sheet, {});
      EXPECT_NEAR(errors.sigma / law_m, 1.0, 0.03) << signal_e << " e, read noise " << read_e;
      EXPECT_NEAR(errors.mean, 0.0, 4.0 * law_m / std::sqrt(20000.0)) << signal_e << " e, read noise " << read_e;
    }
  }
}

TEST(TofNoise, HasThePredictedSigmas) {
  struct Entry {
    double signal_e_m2_per_us, read_e, albedo, integration_s, range_m, sigma_m;
  };
  // 64x48 camera (2000 e m2/us, 200 e), 200x200 (650, 100), 160x120 (330, 100): predictions by the law, to their last
  // digit.
  const Entry entries[] = {
      {2000, 200, 0.9, 1e-4, 1, 5.3e-3}, {2000, 200, 0.9, 1e-4, 4, 50.3e-3}, {2000, 200, 0.5, 1e-4, 2, 24.3e-3},
      {2000, 200, 0.5, 1e-3, 3, 7.4e-3}, {2000, 200, 0.5, 1e-3, 7, 29.1e-3}, {2000, 200, 0.1, 1e-3, 5, 69.5e-3},
      {2000, 200, 0.5, 5e-3, 5, 5.0e-3}, {650, 100, 0.5, 1e-3, 3, 12.3e-3},  {330, 100, 0.5, 1e-3, 4, 31.6e-3},
  };
  for (const Entry& entry : entries) {
    DepthCameraSheet sheet = Sheet();
    sheet.signal_e_m2_per_us = entry.signal_e_m2_per_us;
    sheet.read_noise_e = entry.read_e;
    const Statistics errors =
        RangeErrors({entry.range_m, 1.0, entry.albedo}, sheet, {.integration_s = entry.integration_s});
    EXPECT_NEAR(errors.sigma / entry.sigma_m, 1.0, 0.03) << entry.range_m << " m, " << entry.sigma_m;
  }
}

// Log-log slope of the measured sigma between x and 1.25 x.
double Slope(double x, const std::function<Statistics(double)>& measure) {
  return std::log(measure(1.25 * x).sigma / measure(x).sigma) / std::log(1.25);
}

TEST(TofNoise, GoesFromShotLimitedToReadLimitedSlopes) {
  const DepthCameraSheet sheet = Sheet();
  const auto at_range = [&](double range_m) { return RangeErrors({range_m, 1.0, 0.9}, sheet, {}, 40000); };
  const auto at_range_dark = [&](double range_m) { return RangeErrors({range_m, 1.0, 0.02}, sheet, {}, 40000); };
  const auto at_time = [&](double us) {
    return RangeErrors({0.5, 1.0, 0.9}, sheet, {.integration_s = us * 1e-6}, 40000);
  };
  const auto at_time_dark = [&](double us) {
    return RangeErrors({3.0, 1.0, 0.1}, sheet, {.integration_s = us * 1e-6}, 40000);
  };
  // sigma ~ d^a, a = 2 - N / (N + 2 r^2); sigma ~ T^-b, b = a / 2. Statistical error of a slope: 0.02.
  const double read_2 = 2.0 * 200.0 * 200.0;
  const auto a = [&](double signal_e) { return 2.0 - signal_e / (signal_e + read_2); };
  EXPECT_NEAR(Slope(0.4, at_range), a(1.8e6 / 0.2), 0.08);
  EXPECT_LT(Slope(0.4, at_range), 1.1);
  EXPECT_NEAR(Slope(2.5, at_range_dark), a(4e4 / 7.8), 0.08);
  EXPECT_GT(Slope(2.5, at_range_dark), 1.9);
  EXPECT_NEAR(Slope(2000, at_time), -a(1.6e7) / 2.0, 0.08);
  EXPECT_NEAR(Slope(2000, at_time), -0.5, 0.1);
  EXPECT_NEAR(Slope(150, at_time_dark), -a(3.8e3) / 2.0, 0.08);
  EXPECT_NEAR(Slope(150, at_time_dark), -1.0, 0.1);
}

TEST(TofNoise, HasTheOutlierShareOfLowSignals) {
  const DepthCameraSheet sheet = Sheet();
  for (const double snr : {1.0, 1.5, 2.0, 3.0}) {
    // s = sqrt2 C N / sqrt(N + 2 r^2), solved for N.
    const double h = snr * snr / (4.0 * 0.45 * 0.45);
    const double signal_e = h + std::sqrt(h * h + 2.0 * h * 2.0 * 200.0 * 200.0);
    constexpr int kPixels = 40000;
    const double share = RangeErrors(SceneOf(signal_e, 2.0, sheet, {}), sheet, {}, kPixels).outliers;
    const double expected = 0.5 * std::erfc(snr / std::numbers::sqrt2);
    EXPECT_NEAR(share, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / kPixels)) << snr;
  }
}

TEST(TofSaturation, ClipsExactlyWhenTheFullestTapOverflows) {
  const DepthCameraSheet sheet = Sheet();
  const TofEffects effects{.noise = false, .saturation = true};
  for (const double range_m : {0.4, 0.7, 1.0, 1.5, 2.0}) {
    for (const double integration_s : {1e-4, 3e-4, 1e-3, 2e-3, 5e-3}) {
      const double signal_e = 2000.0 * integration_s * 1e6 * 0.5 / (range_m * range_m);
      const double phi = 2.0 * std::numbers::pi * range_m / kUnambiguous_m;
      const double fullest_e =
          signal_e * (1.0 + 0.45 * std::max(std::abs(std::cos(phi)), std::abs(std::sin(phi)))) / 2.0;
      Random random(1, Sensor::kDepth, 0);
      const PixelTaps taps = ExposePixel({range_m, 1.0, 0.5}, sheet, {.integration_s = integration_s}, effects, random);
      EXPECT_EQ(taps.saturated, fullest_e > 1.5e6) << range_m << " m, " << integration_s << " s";
      EXPECT_LE(*std::max_element(taps.a, taps.a + 4), 1.5e6);
      EXPECT_LE(*std::max_element(taps.b, taps.b + 4), 1.5e6);
    }
  }
}

TEST(TofSaturation, ReachesFartherWithLongerIntegration) {
  const auto farthest_saturated_m = [](double integration_s) {
    double range_m = 0.1;
    while (true) {
      Random random(1, Sensor::kDepth, 0);
      if (!ExposePixel({range_m, 1.0, 0.5}, Sheet(), {.integration_s = integration_s}, kAll, random).saturated)
        return range_m;
      range_m += 0.01;
    }
  };
  double last_m = 0.0;
  for (const double integration_s : {1e-4, 3e-4, 1e-3, 2e-3, 5e-3}) {
    EXPECT_GT(farthest_saturated_m(integration_s), last_m);
    last_m = farthest_saturated_m(integration_s);
  }
}

TEST(TofEffectNames, SwitchWhatTheyName) {
  const auto expect = [](const std::string& text, bool noise, bool saturation) {
    const TofEffects effects = ParseTofEffects(text);
    EXPECT_EQ(effects.noise, noise) << text;
    EXPECT_EQ(effects.saturation, saturation) << text;
  };
  expect("all", true, true);
  expect("ideal", false, false);
  expect("noise", true, false);
  expect("saturation", false, true);
  expect("saturation, noise", true, true);
  expect("-noise", false, true);
  expect(" -noise , -saturation ", false, false);
  expect("all,-saturation", true, false);
}

TEST(TofEffectNames, AreRefusedWhenUnknownNamingTheNearest) {
  const auto error_of = [](const std::string& text) -> std::string {
    try {
      ParseTofEffects(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(error_of("nose").find("unknown effect 'nose'; expected 'noise'"), std::string::npos);
  EXPECT_NE(error_of("-saturatoin").find("expected 'saturation'"), std::string::npos);
  EXPECT_NE(error_of("noise,al").find("expected 'all'"), std::string::npos);
  for (const char* text : {"", ",", "noise,", "-all", "-", "noise saturation"})
    EXPECT_NE(error_of(text), "no error") << text;
}

TEST(TofEffectNames, SwitchNoiseAndClippingOfAPixel) {
  const DepthCameraSheet sheet = Sheet();
  const PixelScene near{0.3, 1.0, 0.9};
  const auto expose = [&](const TofEffects& effects) {
    Random random(1, Sensor::kDepth, 0);
    return ExposePixel(near, sheet, {}, effects, random);
  };
  EXPECT_TRUE(expose(kAll).saturated);
  EXPECT_FALSE(expose(kNoiseOnly).saturated);
  EXPECT_GT(expose(kNoiseOnly).a[0], sheet.full_well_e);
  EXPECT_EQ(expose(kIdeal).a[0] + expose(kIdeal).b[0], expose(kIdeal).a[2] + expose(kIdeal).b[2]);
  EXPECT_NE(expose(kNoiseOnly).a[0], expose(kIdeal).a[0]);
}

// A room whose only wall stands square ahead of a camera at the origin, at x = 3 m; the left half (y > 0) can be bare.
struct WallRoom {
  explicit WallRoom(double y_min_m = -20.0, double x_m = 3.0) {
    const std::string y = std::to_string((20.0 + y_min_m) / 2.0), half = std::to_string((20.0 - y_min_m) / 2.0);
    const std::string xml = "<mujoco><worldbody><geom type='box' size='.1 " + half + " 20' pos='" +
                            std::to_string(x_m + 0.1) + " " + y + " 0'/></worldbody></mujoco>";
    char error[1000] = "";
    mjSpec* spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error));
    EXPECT_NE(spec, nullptr) << error;
    mjModel* model = mj_compile(spec, nullptr);
    mj_deleteSpec(spec);
    scene = std::make_unique<RayScene>(model, std::vector<bool>(1, false));
    mj_deleteModel(model);
  }
  std::unique_ptr<RayScene> scene;
  const double albedo[1] = {0.5};
};

// The optical frame of a camera that looks along the world's x, z up.
Pose Ahead() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return pose;
}

TEST(TofCamera, MeasuresAWallAtThreeMetres) {
  const WallRoom room;
  const DepthCameraSheet sheet = Sheet();
  const TofCamera camera(sheet, kAll, 1);
  double sum_m = 0.0, squares_m2 = 0.0, law_m2 = 0.0, normalised = 0.0;
  int samples = 0;
  for (std::uint64_t index = 0; index < 8; ++index) {
    const DepthFrame frame = camera.Expose(*room.scene, room.albedo, Ahead(), {}, Time{7}, index);
    ASSERT_EQ(frame.size(), 64u * 48u);
    ASSERT_EQ(frame.width, 64);
    ASSERT_EQ(frame.height, 48);
    EXPECT_EQ(frame.index, index);
    EXPECT_EQ(frame.stamp, Time{7});
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 64; ++u) {
        const auto i = static_cast<std::size_t>(64 * v + u);
        // By hand: the ray (x, y, 1) / n meets the plane z = 3 m at range 3 n under the angle with cosine 1 / n.
        const double n = std::hypot((u - 31.5) / 87.9, (v - 23.5) / 89.6, 1.0);
        const double sigma_m = Law_m(2000.0 * 1000.0 * 0.5 / n / (9.0 * n * n), 0.45, 200.0);
        const double error_m = frame.range_m[i] - 3.0 * n;
        EXPECT_EQ(frame.flags[i], 0);
        sum_m += error_m;
        squares_m2 += error_m * error_m;
        law_m2 += sigma_m * sigma_m;
        normalised += error_m * error_m / (sigma_m * sigma_m);
        ++samples;
      }
    }
  }
  ASSERT_GE(samples, 10000);
  const double rms_m = std::sqrt(squares_m2 / samples);
  EXPECT_LE(std::abs(sum_m / samples), 3.0 * rms_m / std::sqrt(samples) + 1e-3);
  EXPECT_NEAR(rms_m / std::sqrt(law_m2 / samples), 1.0, 0.03);
  EXPECT_NEAR(std::sqrt(normalised / samples), 1.0, 0.03);
}

TEST(TofCamera, SeesUprightAndUnmirrored) {
  const WallRoom room(1.0);  // the wall is left of y = 1 m only
  const TofCamera camera(Sheet(), kIdeal, 1);
  const DepthFrame frame = camera.Expose(*room.scene, room.albedo, Ahead(), {}, Time{0}, 0);
  // The edges lie at 31.5 - 87.9 / 3 = 2.2 px (front) and 31.5 - 87.9 / 3.2 = 4.0 px (back).
  EXPECT_EQ(frame.flags[64 * 24 + 2] & kInvalid, 0);
  EXPECT_NE(frame.flags[64 * 24 + 5] & kInvalid, 0);
  Pose rolled = Ahead() * Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());  // image x points down
  const DepthFrame tall = camera.Expose(*room.scene, room.albedo, rolled, {}, Time{0}, 0);
  EXPECT_TRUE(std::ranges::all_of(tall.flags, [](std::uint8_t f) { return f & kInvalid; }));
}

TEST(TofCamera, FlagsPixelsWithoutReturn) {
  const WallRoom room(0.0);  // nothing on the right
  const DepthFrame frame = TofCamera(Sheet(), kAll, 1).Expose(*room.scene, room.albedo, Ahead(), {}, Time{0}, 0);
  double amplitude_e = 0.0;
  for (std::size_t v = 0; v < 48; ++v) {
    for (std::size_t u = 32; u < 64; ++u) {
      const std::size_t i = 64 * v + u;
      ASSERT_EQ(frame.flags[i] & kInvalid, kInvalid);
      ASSERT_EQ(frame.range_m[i], 0.0f);
      amplitude_e += frame.amplitude[i] / (48 * 32);
    }
  }
  // I and Q hold read noise of sigma 2 x 200 e each: the amplitude is Rayleigh's, of mean sigma / 2 sqrt(pi / 2).
  EXPECT_NEAR(amplitude_e, 200.0 * std::sqrt(std::numbers::pi / 2.0), 10.0);
}

TEST(TofCamera, FlagsLowSignalAndSaturation) {
  DepthCameraSheet sheet = Sheet();
  sheet.low_signal_amplitude_e = 1000.0;
  const WallRoom room;
  const auto flags = [&](double integration_s) {
    return TofCamera(sheet, kAll, 1)
        .Expose(*room.scene, room.albedo, Ahead(), {.integration_s = integration_s}, Time{0}, 0)
        .flags;
  };
  // Amplitude 50 e/us at most, full well at 18.6 ms: too dark, right, too bright.
  EXPECT_TRUE(std::ranges::all_of(flags(1e-6), [](std::uint8_t f) { return f == kLowSignal; }));
  EXPECT_TRUE(std::ranges::all_of(flags(1e-3), [](std::uint8_t f) { return f == 0; }));
  EXPECT_TRUE(std::ranges::all_of(flags(1.0), [](std::uint8_t f) { return f & kSaturated; }));
}

TEST(TofCamera, RepeatsItsBitsAndChangesWithSeedAndFrame) {
  const WallRoom room;
  const auto ranges = [&](std::uint64_t seed, std::uint64_t index) {
    return TofCamera(Sheet(), kAll, seed).Expose(*room.scene, room.albedo, Ahead(), {}, Time{0}, index).range_m;
  };
  const auto equal = [](const std::vector<float>& a, const std::vector<float>& b) {
    return std::ranges::count(std::views::iota(std::size_t{0}, a.size()), true,
                              [&](std::size_t i) { return a[i] == b[i]; });
  };
  EXPECT_EQ(ranges(1, 0), ranges(1, 0));
  EXPECT_LT(equal(ranges(1, 0), ranges(2, 0)), 30);  // by chance
  EXPECT_LT(equal(ranges(1, 0), ranges(1, 1)), 30);
}

TEST(TofCamera, KeepsAPixelsNoiseWhateverTheOthersSee) {
  const WallRoom whole, left(0.0);
  const TofCamera camera(Sheet(), kAll, 1);
  const DepthFrame a = camera.Expose(*whole.scene, whole.albedo, Ahead(), {}, Time{0}, 0);
  const DepthFrame b = camera.Expose(*left.scene, left.albedo, Ahead(), {}, Time{0}, 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % 64 < 31) {
      ASSERT_NEAR(a.range_m[i], b.range_m[i], 1e-6f) << i;
    }
  }
}

TEST(TofCamera, WrapsAWallAtNineMetres) {
  const WallRoom room(-20.0, 9.0);
  const DepthFrame frame = TofCamera(Sheet(), kIdeal, 1).Expose(*room.scene, room.albedo, Ahead(), {}, Time{0}, 0);
  const double n = std::hypot(0.5 / 87.9, 0.5 / 89.6, 1.0);
  EXPECT_NEAR(frame.range_m[64 * 24 + 32], 9.0 * n - 7.494811, 1e-4);
}

}  // namespace
}  // namespace merlin::sim
