// Light on other paths than straight there and back: bounces, panes, mirrors, scatter, lamp boards beside the lens.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/tof/returns.h"
#include "tests/sim/tof/stage.h"

namespace merlin::sim {
namespace {

// Two walls at a right angle, with their corner corner_m ahead.
Stage Corner(double corner_m, double albedo) {
  const double s = std::sqrt(0.5);
  const auto wall = [&](double side) -> StageBox {
    // From the corner along (-1, side), one metre thick towards the outside.
    const Eigen::Vector3d along(-s, side * s, 0), out(s, side * s, 0);
    return {Eigen::Vector3d(corner_m, 0, 0) + 15.0 * along + 0.5 * out,
            {30.0 + 2.0, 1.0, 30.0},
            {.nir_albedo = albedo},
            side > 0 ? 135.0 : -135.0};
  };
  return Stage({wall(1.0), wall(-1.0)});
}

struct WallPoint {
  Eigen::Vector3d point, normal;
  double range_m;
};

// Where the ray with these slopes (x right, y down) meets the walls, which are at x + |y| = corner.
WallPoint MeetCorner(double corner_m, double slope_x, double slope_y) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1.0, -slope_x, -slope_y).normalized();
  const double range_m = corner_m / (direction.x() + std::abs(direction.y()));
  const double s = std::sqrt(0.5);
  return {range_m * direction, {-s, direction.y() > 0 ? -s : s, 0.0}, range_m};
}

// One bounce for one pixel: the integral, over 8192 patches, of all that a uniform 40x30 degree lamp at the lens
// lights.
double BruteForceRange_m(double corner_m, double albedo, int u, int v) {
  constexpr int kX = 128, kY = 64;
  const DepthCameraSheet sheet = Sheet3kS();
  const double tan_x = std::tan(20.0 * kPi / 180.0), tan_y = std::tan(15.0 * kPi / 180.0);
  const WallPoint p = MeetCorner(corner_m, (u - 31.5) / sheet.camera.fx_px, (v - 23.5) / sheet.camera.fy_px);
  const double direct = albedo * -p.normal.dot(p.point / p.range_m) / (p.range_m * p.range_m);
  std::vector<Way> ways{{direct, p.range_m}};
  for (int j = 0; j < kY; ++j) {
    for (int i = 0; i < kX; ++i) {
      const double x = tan_x * ((2.0 * i + 1.0) / kX - 1.0), y = tan_y * ((2.0 * j + 1.0) / kY - 1.0);
      const WallPoint q = MeetCorner(corner_m, x, y);
      if (q.normal.dot(p.normal) > 0.5) continue;  // the same wall
      const double solid_angle = 4.0 * tan_x * tan_y / (kX * kY) * std::pow(1.0 + x * x + y * y, -1.5);
      const Eigen::Vector3d way = p.point - q.point;
      const double r = way.norm();
      const double cos_q = q.normal.dot(way) / r, cos_p = -p.normal.dot(way) / r;
      ways.push_back(
          {albedo * albedo / kPi * solid_angle * cos_q * cos_p / (r * r), (q.range_m + r + p.range_m) / 2.0});
    }
  }
  return RangeOfWays(ways, p.range_m);
}

double Bulge_m(const std::vector<double>& errors_m) { return *std::ranges::max_element(errors_m); }

// Component of a range error along the pixel's ray that is perpendicular to the wall.
double OffTheWall_m(double error_m, double corner_m, int u) {
  const WallPoint p = MeetCorner(corner_m, (u - 31.5) / Sheet3kS().camera.fx_px, 0.5 / Sheet3kS().camera.fy_px);
  return error_m * -p.normal.dot(p.point / p.range_m);
}

TEST(TofMultipath, BulgesACornerAsABruteForceIntegralDoes) {
  // From an independent one-bounce quadrature: offset from walls of albedo 0.7 with the corner at 1, 2, 3 and 4 m.
  const double about_mm[] = {15, 29, 45, 59};
  for (int corner_m = 1; corner_m <= 4; ++corner_m) {
    const Stage stage = Corner(corner_m, 0.7);
    const DepthFrame bounced = stage.Expose("multipath"), straight = stage.Expose("ideal");
    std::vector<double> ours_m, brute_m, off_wall_m;
    for (int u = 0; u < 64; ++u) {
      const double true_m = straight.range_m[Pixel(u, 24)];
      ours_m.push_back(bounced.range_m[Pixel(u, 24)] - true_m);
      brute_m.push_back(BruteForceRange_m(corner_m, 0.7, u, 24) - true_m);
      off_wall_m.push_back(OffTheWall_m(ours_m.back(), corner_m, u));
    }
    EXPECT_NEAR(Bulge_m(ours_m) / Bulge_m(brute_m), 1.0, 0.1) << corner_m << " m";
    EXPECT_NEAR(Bulge_m(off_wall_m) * 1e3 / about_mm[corner_m - 1], 1.0, 0.1) << corner_m << " m";
    double squares = 0.0, brute_squares = 0.0;  // over the whole profile
    for (std::size_t i = 0; i < ours_m.size(); ++i) {
      squares += std::pow(ours_m[i] - brute_m[i], 2);
      brute_squares += std::pow(brute_m[i], 2);
    }
    EXPECT_LT(std::sqrt(squares / brute_squares), 0.15) << corner_m << " m";
    const Stage dark = Corner(corner_m, 0.1);
    const DepthFrame dark_bounced = dark.Expose("multipath"), dark_straight = dark.Expose("ideal");
    std::vector<double> dark_m;
    for (int u = 0; u < 64; ++u)
      dark_m.push_back(dark_bounced.range_m[Pixel(u, 24)] - dark_straight.range_m[Pixel(u, 24)]);
    EXPECT_LT(Bulge_m(dark_m), 0.2 * Bulge_m(ours_m)) << corner_m << " m";
  }
}

TEST(TofMultipath, LeavesAFlatWallAlone) {
  const Stage stage({Wall(2.0, 0.9)});
  const DepthFrame bounced = stage.Expose("multipath"), straight = stage.Expose("ideal");
  EXPECT_EQ(bounced.range_m, straight.range_m);
}

TEST(TofMultipath, KeepsToWhatTheLampReaches) {
  // A board between the two walls keeps the light of one from the other.
  std::vector<StageBox> boxes;
  const double s = std::sqrt(0.5);
  for (const double side : {1.0, -1.0})
    boxes.push_back(
        {Eigen::Vector3d(2.0, 0, 0) + 15.0 * Eigen::Vector3d(-s, side * s, 0) + 0.5 * Eigen::Vector3d(s, side * s, 0),
         {32.0, 1.0, 30.0},
         {.nir_albedo = 0.7},
         side > 0 ? 135.0 : -135.0});
  boxes.push_back({{1.3, 0, 0}, {1.3, 0.002, 30.0}, {.nir_albedo = 0.0}});
  const Stage parted(boxes);
  const DepthFrame bounced = parted.Expose("multipath"), straight = parted.Expose("ideal");
  for (const int u : {10, 16, 48, 54})
    EXPECT_NEAR(bounced.range_m[Pixel(u, 24)], straight.range_m[Pixel(u, 24)], 1e-3) << u;
}

// The uniform part of the scatter: 0.006 of the mean phasor, by hand from the ideal frame's ranges and amplitudes.
TEST(TofScatter, PullsDarkWallsTowardsABrightPlateAsTheMeanPhasorDoes) {
  const DepthCameraErrors errors{.scatter_share = 0.006, .scatter_flat = 1.0};
  const struct {
    double wall_m, albedo, plate_share, about_m;
  } cases[] = {{2.0, 0.5, 0.1, -0.020}, {3.0, 0.1, 0.1, -0.220}, {3.0, 0.1, 0.5, -1.2}};
  for (const auto& [wall_m, albedo, plate_share, about_m] : cases) {
    // The plate covers the left of the picture.
    const double tan_x = std::tan(20.0 * kPi / 180.0), edge_y_m = 0.5 * tan_x * (1.0 - 2.0 * plate_share);
    const Stage stage({Wall(wall_m, albedo), {{0.51, edge_y_m + 1.0, 0}, {0.02, 2.0, 2.0}, {.nir_albedo = 0.9}}});
    const DepthFrame plain = stage.Expose("ideal"), scattered = stage.Expose("scatter", {}, errors);
    double re = 0.0, im = 0.0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      re += plain.amplitude[i] * std::cos(WaveNumber(20e6) * plain.range_m[i]) / static_cast<double>(plain.size());
      im += plain.amplitude[i] * std::sin(WaveNumber(20e6) * plain.range_m[i]) / static_cast<double>(plain.size());
    }
    const double mean_m = std::atan2(im, re) / WaveNumber(20e6);
    const std::size_t pixel = Pixel(48, 24);
    const double by_hand_m = RangeOfWays(
        {{0.994 * plain.amplitude[pixel], plain.range_m[pixel]}, {0.006 * std::hypot(re, im), mean_m}}, wall_m);
    EXPECT_NEAR(scattered.range_m[pixel], by_hand_m, 1e-3) << wall_m << " m, " << albedo;
    EXPECT_NEAR((by_hand_m - plain.range_m[pixel]) / about_m, 1.0, 0.25)
        << wall_m << " m, " << albedo << ", " << plate_share;
  }
}

// Fresnel reflectance of a slab with two faces at this angle of incidence, written out for both polarisations.
double Slab(double angle_rad) {
  const double inside_rad = std::asin(std::sin(angle_rad) / 1.52);
  const double normal = std::pow(0.52 / 2.52, 2);
  const double s =
      angle_rad == 0.0 ? normal : std::pow(std::sin(angle_rad - inside_rad) / std::sin(angle_rad + inside_rad), 2);
  const double p =
      angle_rad == 0.0 ? normal : std::pow(std::tan(angle_rad - inside_rad) / std::tan(angle_rad + inside_rad), 2);
  return 0.5 * (2 * s / (1 + s) + 2 * p / (1 + p));
}

TEST(TofGlass, ReflectsAndPassesAsFresnelSays) {
  EXPECT_NEAR(PaneAt(1.0, 1.0).reflected, 0.082, 0.0005);
  EXPECT_NEAR(PaneAt(1.0, 1.0).passed, 0.918, 0.0005);
  for (const double angle_deg : {0.0, 10.0, 45.0, 56.66, 80.0}) {
    const double slab = Slab(angle_deg * kPi / 180.0);
    const double inside_rad = std::asin(std::sin(angle_deg * kPi / 180.0) / 1.52);
    const PaneOptics pane = PaneAt(std::cos(angle_deg * kPi / 180.0), 0.89);
    EXPECT_NEAR(pane.reflected, slab, 1e-9) << angle_deg;
    EXPECT_NEAR(pane.passed, (1 - slab) * std::pow(0.89, 1 / std::cos(inside_rad)), 1e-9) << angle_deg;
  }
  EXPECT_NEAR(PaneAt(0.0, 0.89).reflected, 1.0, 1e-9);
  EXPECT_NEAR(PaneAt(0.0, 0.89).passed, 0.0, 1e-9);
}

TEST(TofGlass, MixesThePaneWithWhatIsBehindIt) {
  DepthCameraSheet sheet = Sheet3kS();
  sheet.camera = {.width = 1, .height = 1, .fx_px = 100, .fy_px = 100, .cx_px = 0, .cy_px = 0};
  constexpr double kDirt = 0.02, kWallAlbedo = 0.5;
  for (const double angle_deg : {20.0, 45.0, 70.0}) {
    for (const double wall_m : {2.0, 4.0, 6.5}) {
      const Stage stage(
          {Wall(wall_m, kWallAlbedo),
           {{1.0, 0, 0}, {0.0002, 20.0, 2.0}, {.nir_albedo = kDirt, .glass_transmission = 0.89}, angle_deg}});
      const double angle_rad = angle_deg * kPi / 180.0, slab = Slab(angle_rad);
      const double passed = (1 - slab) * std::pow(0.89, 1 / std::sqrt(1 - std::pow(std::sin(angle_rad) / 1.52, 2)));
      std::vector<Way> ways{{kDirt * std::cos(angle_rad), 1.0},
                            {passed * passed * kWallAlbedo / (wall_m * wall_m), wall_m}};
      if (angle_deg > 45.0) {  // the mirrored ray meets the wall at this angle to its normal
        const double off_rad = kPi - 2 * angle_rad, way_m = 1.0 + (wall_m - 1.0) / std::cos(off_rad);
        ways.push_back({slab * slab * kWallAlbedo * std::cos(off_rad) / (way_m * way_m), way_m});
      }
      const DepthFrame frame = stage.Expose("glass", {}, {}, sheet);
      EXPECT_NEAR(frame.range_m[0], RangeOfWays(ways, frame.range_m[0]), 2e-3)
          << angle_deg << " deg, " << wall_m << " m";
      double amplitude_e = 0.0, re = 0.0, im = 0.0;
      for (const Way& way : ways)
        re += way.electrons * std::cos(WaveNumber(20e6) * way.range_m),
            im += way.electrons * std::sin(WaveNumber(20e6) * way.range_m);
      amplitude_e = 0.45 * 2e6 * std::hypot(re, im);
      EXPECT_NEAR(frame.amplitude[0] / amplitude_e, 1.0, 0.01) << angle_deg << " deg, " << wall_m << " m";
    }
  }
}

TEST(TofGlass, BlindsTheCameraOnlyNearNormalIncidence) {
  const auto saturated = [](double angle_deg) {
    const Stage stage(
        {Wall(6.0), {{1.5, 0, 0}, {0.006, 20.0, 20.0}, {.nir_albedo = 0.02, .glass_transmission = 0.89}, angle_deg}});
    const DepthFrame frame = stage.Expose("glass,saturation");
    return (frame.flags[Pixel(31, 23)] & kSaturated) != 0;
  };
  EXPECT_TRUE(saturated(0.0));
  for (const double angle_deg : {4.0, -4.0, 10.0, 30.0}) EXPECT_FALSE(saturated(angle_deg)) << angle_deg;
}

TEST(TofSpecular, SeesBehindAMirror) {
  DepthCameraSheet sheet = Sheet3kS();
  sheet.camera = {.width = 1, .height = 1, .fx_px = 100, .fy_px = 100, .cx_px = 0, .cy_px = 0};
  // A mirror at 2 m that turns the ray by 90 degrees, to the left, onto a wall 1.5 m away.
  const Stage stage({{{2.0, 0, 0}, {0.0002, 3.0, 3.0}, {.nir_albedo = 0.0, .mirror = 0.9}, -45.0},
                     {{2.0, 2.0, 0}, {6.0, 1.0, 6.0}, {.nir_albedo = 0.6}},
                     {{2.0, -2.0, 0}, {6.0, 1.0, 6.0}, {.nir_albedo = 0.6}}});
  const DepthFrame frame = stage.Expose("specular", {}, {}, sheet);
  EXPECT_NEAR(frame.range_m[0], 3.5, 1e-3);
  EXPECT_NEAR(frame.amplitude[0] / (0.45 * 2e6 * 0.81 * 0.6 / (3.5 * 3.5)), 1.0, 0.01);
  EXPECT_TRUE(stage.Expose("ideal", {}, {}, sheet).range_m[0] < 2.1f ||
              stage.Expose("ideal", {}, {}, sheet).flags[0] & kInvalid);
}

TEST(TofSpecular, SeesARetroReflectorByItsGain) {
  const Stage plain({Wall(4.0, 0.2)}), retro({{{4.5, 0, 0}, {1, 60, 60}, {.nir_albedo = 0.2, .retro_gain = 300}}});
  EXPECT_NEAR(retro.Expose("specular").amplitude[1000] / plain.Expose("specular").amplitude[1000], 300.0, 0.1);
  EXPECT_TRUE(retro.Expose("specular,saturation").flags[1000] & kSaturated);
}

// Two boards, exactly: two phasors of half the lamp each, on the path from the board to the wall and back to the lens.
TEST(TofLamp, MeasuresTheMeanOfThePathsFromItsBoards) {
  const DepthCameraErrors errors{.lamp_baseline_m = 0.12, .lamp_at_edge = 1.0};
  const DepthCameraSheet sheet = Sheet3kS();
  for (const double wall_m : {0.3, 0.5, 1.0, 4.0}) {
    const DepthFrame frame = Stage({Wall(wall_m)}).Expose("lamp", {}, errors);
    for (const int u : {0, 16, 32, 63}) {
      const double x = (u - 31.5) / sheet.camera.fx_px, y = 0.5 / sheet.camera.fy_px, n = std::sqrt(1 + x * x + y * y);
      std::vector<Way> ways;
      double electrons = 0.0;
      for (const double board_m : {-0.12, 0.12}) {
        const double from_board_m = std::hypot(wall_m * x - board_m, wall_m * y, wall_m);
        ways.push_back({0.5 * wall_m / std::pow(from_board_m, 3), (from_board_m + wall_m * n) / 2.0});
        electrons += ways.back().electrons;
      }
      EXPECT_NEAR(frame.range_m[Pixel(u, 24)], RangeOfWays(ways, wall_m), 1e-4) << wall_m << " m, column " << u;
      EXPECT_NEAR(frame.amplitude[Pixel(u, 24)] / (0.45 * 2e6 * 0.5 * electrons / std::pow(n, 4)), 1.0, 2e-3) << wall_m;
    }
  }
}

TEST(TofLamp, FallsToHalfAtTheEdgeOfTheView) {
  DepthCameraSheet sheet = Sheet3kS();
  const DepthFrame lobe = Stage({Wall(3.0)}).Expose("lamp", {}, {.lamp_at_edge = 0.5}),
                   even = Stage({Wall(3.0)}).Expose("lamp", {}, {.lamp_at_edge = 1.0});
  EXPECT_NEAR(lobe.amplitude[Pixel(32, 24)] / even.amplitude[Pixel(32, 24)], 1.0, 1e-3);
  EXPECT_NEAR(lobe.amplitude[Pixel(0, 24)] / even.amplitude[Pixel(0, 24)], std::pow(0.5, std::pow(31.5 / 32.0, 2)),
              1e-3);
}

TEST(TofLamp, CastsTheShadowOfAPostFromEachBoard) {
  const DepthCameraErrors errors{.lamp_baseline_m = 0.12, .lamp_at_edge = 1.0};
  // A post 4 cm wide at 1 m in front of a wall at 2 m. The board at x = -0.12 (left) casts its shadow to the right, to
  // x = 0.12 +- 0.04 m on the wall; the other board casts it to the left.
  const Stage post({Wall(2.0), {{1.0, 0, 0}, {0.001, 0.04, 10.0}}}), bare({Wall(2.0)});
  const DepthFrame with = post.Expose("lamp", {}, errors), without = bare.Expose("lamp", {}, errors);
  const auto dimming = [&](double x_m) {
    const std::size_t pixel = Pixel(static_cast<int>(std::lround(31.5 + 87.918 * x_m / 2.0)), 24);
    return with.amplitude[pixel] / without.amplitude[pixel];
  };
  EXPECT_NEAR(dimming(0.12), 0.5, 0.01);
  EXPECT_NEAR(dimming(-0.12), 0.5, 0.01);
  for (const double x_m : {0.3, -0.3, 0.5}) EXPECT_NEAR(dimming(x_m), 1.0, 1e-3) << x_m;
}

}  // namespace
}  // namespace merlin::sim
