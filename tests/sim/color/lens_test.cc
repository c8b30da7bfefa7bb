// Compares the lens with the published formula of its distortion, inverted here by another method.
#include "sim/color/lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/thesis_ccd.h"

namespace merlin::sim {
namespace {

const CameraModel kOddBarrel{.width = 161,
                             .height = 90,
                             .fx_px = 110.0,
                             .fy_px = 115.0,
                             .cx_px = 75.5,
                             .cy_px = 50.0,
                             .k1 = -0.25,
                             .k2 = 0.05,
                             .p1 = 0.004,
                             .p2 = -0.003};

struct Slope {
  double x = 0.0, y = 0.0;  // x / z, y / z
};

// OpenCV's documentation of its calib3d module, "detailed description".
Slope Distorted(const CameraModel& c, const Slope& s) {
  const double r2 = s.x * s.x + s.y * s.y, radial = 1.0 + c.k1 * r2 + c.k2 * r2 * r2;
  return {s.x * radial + 2.0 * c.p1 * s.x * s.y + c.p2 * (r2 + 2.0 * s.x * s.x),
          s.y * radial + c.p1 * (r2 + 2.0 * s.y * s.y) + 2.0 * c.p2 * s.x * s.y};
}

// Inverts it by fixed-point iteration, which converges for lenses as mild as these.
Slope SlopeOfPixel(const CameraModel& c, double u, double v) {
  const Slope wanted{(u - c.cx_px) / c.fx_px, (v - c.cy_px) / c.fy_px};
  Slope s = wanted;
  for (int i = 0; i < 200; ++i) {
    const Slope d = Distorted(c, s);
    s = {s.x + wanted.x - d.x, s.y + wanted.y - d.y};
  }
  return s;
}

// A pattern in the world with wavelengths of 30 pixels in x and 40 in y; it changes by up to 20 grey values per pixel.
double Pattern(const CameraModel& c, const Slope& s, int channel) {
  const double u = c.fx_px * s.x, v = c.fy_px * s.y, two_pi = 2.0 * std::numbers::pi;
  return 128.0 + 95.0 * std::sin(two_pi * u / 30.0 + channel) * std::sin(two_pi * v / 40.0 + 2.0 * channel);
}

TEST(Lens, GivesEachPixelWhatLiesAlongItsOwnRay) {
  for (const CameraModel& camera : {kThesisCcd, kOddBarrel}) {
    const Lens lens(camera);
    const CameraModel& wide = lens.pinhole();
    EXPECT_FALSE(wide.Distorts());
    std::vector<std::uint8_t> drawn, seen(3 * static_cast<std::size_t>(camera.width) * camera.height);
    for (int v = 0; v < wide.height; ++v)
      for (int u = 0; u < wide.width; ++u)
        for (int channel = 0; channel < 3; ++channel)
          drawn.push_back(static_cast<std::uint8_t>(
              std::lround(Pattern(wide, {(u - wide.cx_px) / wide.fx_px, (v - wide.cy_px) / wide.fy_px}, channel))));
    lens.Remap(drawn, seen);
    double sum = 0.0;
    std::size_t i = 0;
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const Slope slope = SlopeOfPixel(camera, u, v);
        for (int channel = 0; channel < 3; ++channel, ++i) {
          const double error = seen[i] - Pattern(camera, slope, channel);
          // Two roundings, 1/512 pixel in u and v, and the chord below a wave: 95 (2 pi / 30)^2 / 8 and the same in v.
          ASSERT_NEAR(error, 0.0, 1.0 + 0.1 + 0.53 + 0.3) << u << " " << v;
          sum += error;
        }
      }
    EXPECT_NEAR(sum / static_cast<double>(i), 0.0, 0.02);
  }
}

TEST(Lens, ChangesNothingWithoutDistortion) {
  const CameraModel camera{.width = 5, .height = 3, .fx_px = 4.1, .fy_px = 4.2, .cx_px = 1.9, .cy_px = 1.1};
  const Lens lens(camera);
  EXPECT_EQ(lens.pinhole().width, 5);
  EXPECT_EQ(lens.pinhole().cx_px, 1.9);
  std::vector<std::uint8_t> picture(45), seen(45);
  for (std::uint8_t i = 0; i < 45; ++i) picture[i] = static_cast<std::uint8_t>(5 * i);
  lens.Remap(picture, seen);
  EXPECT_EQ(seen, picture);
}

TEST(Lens, KeepsTheDensityOfPixelsAndAsksForNoMoreThanItNeeds) {
  const Lens lens(kThesisCcd);
  EXPECT_EQ(lens.pinhole().fx_px, kThesisCcd.fx_px);
  EXPECT_EQ(lens.pinhole().fy_px, kThesisCcd.fy_px);
  Slope least{1e9, 1e9}, most{-1e9, -1e9};
  for (int v = 0; v < kThesisCcd.height; ++v)
    for (int u = 0; u < kThesisCcd.width; ++u) {
      const Slope s = SlopeOfPixel(kThesisCcd, u, v);
      least = {std::min(least.x, s.x), std::min(least.y, s.y)};
      most = {std::max(most.x, s.x), std::max(most.y, s.y)};
    }
  EXPECT_NEAR(lens.pinhole().width, kThesisCcd.fx_px * (most.x - least.x) + 1.0, 2.0);
  EXPECT_NEAR(lens.pinhole().height, kThesisCcd.fy_px * (most.y - least.y) + 1.0, 2.0);
}

}  // namespace
}  // namespace merlin::sim
