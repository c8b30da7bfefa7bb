#include "perception/project.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "perception/fuse.h"

namespace merlin {
namespace {

DepthCameraSheet WideSheet() {
  DepthCameraSheet sheet;
  sheet.camera = {.width = 3, .height = 3, .fx_px = 1.0, .fy_px = 1.0, .cx_px = 1.0, .cy_px = 1.0};  // rays at 45 deg
  sheet.signal_e_m2_per_us = 2000.0;
  sheet.contrast_at_20mhz = 0.45;
  sheet.contrast_corner_hz = 30e6;
  sheet.read_noise_e = 200.0;
  return sheet;
}

// Optical z is the body's x, optical x its -y, optical y its -z.
Pose LookingAhead(double x_m, double z_m) {
  Pose T = Pose::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.translation() = Eigen::Vector3d(x_m, 0.0, z_m);
  return T;
}

FilteredDepth Depth() {
  FilteredDepth depth;
  depth.frame.width = depth.frame.height = 3;
  depth.frame.range_m.assign(9, 2.0f);
  depth.frame.amplitude.assign(9, 50'000.0f);
  depth.frame.flags.assign(9, 0);
  depth.reasons.assign(9, Rejection::kInvalid);
  return depth;
}

TEST(Project, PutsPixelsWhereTheirRaysPointInTheBodyFrame) {
  FilteredDepth depth = Depth();
  depth.reasons[4] = Rejection::kNone;  // centre
  depth.reasons[3] = Rejection::kNone;  // left of it
  depth.reasons[7] = Rejection::kNone;  // below it
  Observation observation;
  ProjectDepth(depth, WideSheet(), PixelRays(WideSheet().camera), LookingAhead(0.3, 0.35), observation);
  ASSERT_EQ(observation.points_base.size(), 3u);
  const float s = std::sqrt(2.0f);  // 2 m along a ray at 45 deg
  EXPECT_TRUE(observation.points_base[0].position.isApprox(Eigen::Vector3f(0.3f + s, s, 0.35f), 1e-6f));
  EXPECT_TRUE(observation.points_base[1].position.isApprox(Eigen::Vector3f(2.3f, 0.0f, 0.35f), 1e-6f));
  EXPECT_TRUE(observation.points_base[2].position.isApprox(Eigen::Vector3f(0.3f + s, 0.0f, 0.35f - s), 1e-6f));
  EXPECT_TRUE(observation.camera_base.isApprox(Eigen::Vector3f(0.3f, 0.0f, 0.35f), 1e-6f));
}

TEST(Project, TellsHowFarRaysAreFreeThatAreTooDarkToMeasure) {
  // 900,000 e at 1 m of albedo 1: 0.02 of it falls to 2,000 e at 3 m, and to the sheet's least, 4,500 e, at 2 m.
  DepthCameraSheet sheet = WideSheet();
  sheet.low_signal_amplitude_e = 4'500.0;
  FilteredDepth depth = Depth();
  depth.frame.settings.integration_s = 1e-3;
  const auto pixel = [&depth](std::size_t i, Rejection reason, int flags, float amplitude_e) {
    depth.reasons[i] = reason, depth.frame.flags[i] = static_cast<std::uint8_t>(flags),
    depth.frame.amplitude[i] = amplitude_e;
  };
  pixel(4, Rejection::kGhost, 0, 8'000.0f);  // 1.5 m straight ahead
  pixel(3, Rejection::kLowSignal, kLowSignal, 600.0f);
  pixel(0, Rejection::kInvalid, kInvalid | kLowSignal, std::nanf(""));  // as a driver may say it
  pixel(1, Rejection::kSaturated, kSaturated | kLowSignal, 0.0f);
  pixel(2, Rejection::kLonely, 0, 8'000.0f);
  pixel(5, Rejection::kInvalid, kInvalid | kSaturated | kLowSignal, 0.0f);  // clipped, and what is left is dark
  pixel(6, Rejection::kInconsistent, kInconsistent | kLowSignal, 600.0f);
  Observation observation;
  ProjectDepth(depth, sheet, PixelRays(sheet.camera), LookingAhead(0.3, 0.35), observation);
  ASSERT_EQ(observation.free_base.size(), 3u);
  const Eigen::Vector3f camera(0.3f, 0.0f, 0.35f);
  EXPECT_NEAR((observation.free_base[0] - camera).norm(), 2.0f, 1e-5f);
  EXPECT_NEAR((observation.free_base[1] - camera).norm(), 2.0f, 1e-5f);
  EXPECT_TRUE(observation.free_base[2].isApprox(Eigen::Vector3f(1.8f, 0.0f, 0.35f), 1e-6f));
  EXPECT_EQ(observation.saturated_base.size(), 1u);
  EXPECT_EQ(observation.unknown_base.size(), 5u);  // 2, 5, 6 and the two that nothing was said of
  EXPECT_TRUE(observation.points_base.empty());
  sheet.low_signal_amplitude_e = 0.0;
  EXPECT_EQ(FreeRange(sheet, depth.frame.settings).Of_m(0.0), UnambiguousRange_m(depth.frame.settings));
}

TEST(Project, KeepsSaturatedPixelsAsDirections) {
  FilteredDepth depth = Depth();
  depth.reasons[4] = Rejection::kSaturated;
  Observation observation;
  ProjectDepth(depth, WideSheet(), PixelRays(WideSheet().camera), LookingAhead(0.3, 0.35), observation);
  EXPECT_TRUE(observation.points_base.empty());
  ASSERT_EQ(observation.saturated_base.size(), 1u);
  EXPECT_TRUE(observation.saturated_base[0].isApprox(Eigen::Vector3f::UnitX(), 1e-6f));
}

// Figures computed by hand from c / (4 sqrt2 pi f) = 0.844 m at 20 MHz and sqrt(N + 2 200^2) / (0.45 N): albedo 0.5, 1 ms.
TEST(RangeSigma, GivesTheHandComputedMillimetres) {
  for (const auto& [distance_m, sigma_mm] :
       {std::pair(1.0, 1.9), {2.0, 4.3}, {3.0, 7.4}, {4.0, 11.3}, {5.0, 16.2}, {7.0, 29.1}}) {
    const double amplitude_e = 0.45 * 2000.0 * 0.5 * 1000.0 / (distance_m * distance_m);
    EXPECT_NEAR(1e3 * RangeSigma(WideSheet(), {1e-3, 20e6}).Of_m(amplitude_e), sigma_mm, 0.03 * sigma_mm + 0.05)
        << distance_m;
  }
}

ColorFrame Picture() {  // 4 x 2, the blue channel counts the pixels
  ColorFrame frame;
  frame.width = 4;
  frame.height = 2;
  for (std::uint8_t i = 0; i < 8; ++i) frame.bgr.insert(frame.bgr.end(), {i, 100, 200});
  return frame;
}

TEST(Fuse, ColorsThePointThatFallsOnAPixelAndNoOther) {
  const CameraModel camera{.width = 4, .height = 2, .fx_px = 2.0, .fy_px = 2.0, .cx_px = 1.0, .cy_px = 0.0};
  std::vector<Point> points(4);
  points[0].position = {2.0f, 1.0f, 2.0f};   // u = 2 * 1 + 1 = 3, v = 1: the last pixel
  points[1].position = {10.0f, 0.0f, 2.0f};  // right of the picture
  points[2].position = {0.0f, 0.0f, -2.0f};  // behind the camera
  points[3].position = {0.0f, 0.0f, 0.0f};   // in it
  ColorPoints(points, Picture(), camera, Pose::Identity(), 0.01);
  EXPECT_TRUE(points[0].has_color);
  EXPECT_EQ(points[0].bgr, (std::array<std::uint8_t, 3>{7, 100, 200}));
  for (int i = 1; i < 4; ++i) EXPECT_FALSE(points[i].has_color) << i;
}

// x (1 - x^2 / 2): a point at x = 0.7 appears at 0.5285, and one at 1.0 would fold back to 0.5.
TEST(Fuse, TakesThePixelTheLensPutsThePointOnAndNoneBeyondItsFold) {
  const CameraModel camera{.width = 4, .height = 2, .fx_px = 4.0, .fy_px = 4.0, .cx_px = 1.0, .cy_px = 0.0, .k1 = -0.5};
  std::vector<Point> points(2);
  points[0].position = {0.7f, 0.0f, 1.0f};  // u = 4 * 0.5285 + 1 = 3.1; without the lens 3.8, outside
  points[1].position = {1.0f, 0.0f, 1.0f};
  ColorPoints(points, Picture(), camera, Pose::Identity(), 0.01);
  EXPECT_TRUE(points[0].has_color);
  EXPECT_EQ(points[0].bgr[0], 3);
  EXPECT_FALSE(points[1].has_color);
}

// A depth camera's grid of rays, each as long as `depth_m` says for its slopes to the right and down.
constexpr double kPixel_rad = 0.011;

template <class Depth>
std::vector<Point> SeenBy64x48(Depth depth_m) {
  std::vector<Point> points;
  for (int v = -24; v < 24; ++v)
    for (int u = -32; u < 32; ++u) {
      const double x = (u + 0.5) * kPixel_rad, y = (v + 0.5) * kPixel_rad, z_m = depth_m(x, y);
      points.push_back({.position = Eigen::Vector3d(x * z_m, y * z_m, z_m).cast<float>()});
    }
  return points;
}

// 7 cm above the depth camera and looking the same way, with room around.
struct ColorCameraAbove {
  CameraModel camera{.width = 640, .height = 480, .fx_px = 700.0, .fy_px = 700.0, .cx_px = 319.5, .cy_px = 239.5};
  ColorFrame frame;
  ColorCameraAbove() { frame.width = 640, frame.height = 480, frame.bgr.assign(3 * 640 * 480, 200); }
  Pose T_color_base = Pose(Eigen::Translation3d(0.0, 0.07, 0.0));
};

// A board at 1 m covers what lies above the axis, a wall stands at 3 m: from 7 cm higher up the board's lower edge hides the
// wall down to 3 x 0.07 - 0.07 = 0.14 m below the axis.
TEST(Fuse, PaintsNoSurfaceThatAnotherHidesFromTheColourCamera) {
  const ColorCameraAbove above;
  std::vector<Point> points = SeenBy64x48([](double, double down) { return down < 0.0 ? 1.0 : 3.0; });
  ColorPoints(points, above.frame, above.camera, above.T_color_base, kPixel_rad);
  int hidden = 0;
  for (const Point& point : points) {
    const double down_m = point.position.y(), pixel_m = 3.0 * kPixel_rad;
    const bool is_wall = point.position.z() > 2.0f, is_hidden = is_wall && down_m < 0.14 - pixel_m;
    const bool is_seen = !is_wall || down_m > 0.14 + pixel_m;
    EXPECT_TRUE(point.has_color || !is_seen) << point.position.transpose();
    EXPECT_FALSE(point.has_color && is_hidden) << point.position.transpose();
    hidden += is_hidden;
  }
  EXPECT_GE(hidden, 3 * 64);  // rows at 1.7, 5.0 and 8.3 cm
}

TEST(Fuse, PaintsAllOfFloorsAndWallsSeenAtGrazingAngles) {
  const ColorCameraAbove above;
  const auto floor_and_wall = [](double right, double down) {  // 0.35 m below and 0.5 m to the right, to 12 m ahead
    return std::min({12.0, down > 0.0 ? 0.35 / down : 12.0, right > 0.0 ? 0.5 / right : 12.0});
  };
  std::vector<Point> points = SeenBy64x48(floor_and_wall);
  ColorPoints(points, above.frame, above.camera, above.T_color_base, kPixel_rad);
  for (const Point& point : points) EXPECT_TRUE(point.has_color) << point.position.transpose();
}

TEST(Fuse, LeavesPointsThatAreNotFiniteUnpainted) {
  const ColorCameraAbove above;
  std::vector<Point> points(3);
  points[0].position = {0.0f, 0.0f, std::nanf("")};
  points[1].position = {0.0f, 0.0f, HUGE_VALF};
  points[2].position = {std::nanf(""), 0.0f, 1.0f};
  ColorPoints(points, above.frame, above.camera, above.T_color_base, kPixel_rad);
  for (const Point& point : points) EXPECT_FALSE(point.has_color);
  ColorPoints({}, above.frame, above.camera, above.T_color_base, kPixel_rad);
}

}  // namespace
}  // namespace merlin
