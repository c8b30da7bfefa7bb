// Studies of pixels that see more than one surface: at an edge, and through a pane.
#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tools/camera/study_parts.h"

namespace merlin::study {
namespace {

constexpr double kEdgeTurn_rad = 0.32175;  // atan(1/3): the edge passes the nine sub-rays one after the other

Phasor Return(const StudyCamera& camera, double amplitude, double range_m) {
  return std::polar(amplitude / (range_m * range_m), Phase_rad(camera, range_m));
}

double RangeOfSum_m(const StudyCamera& camera, const Phasor& sum) {
  const double phase = std::arg(sum);
  return RangeOf_m(camera, phase < 0.0 ? phase + 2.0 * std::numbers::pi : phase);
}

// Share of a unit square that lies below an edge: a line that is rotated, and shifted along its normal from the middle.
double CoveredShare(double shift) {
  constexpr int kGrid = 200;
  int covered = 0;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) {
      const double x = (i + 0.5) / kGrid - 0.5, y = (j + 0.5) / kGrid - 0.5;
      covered += x * std::cos(kEdgeTurn_rad) + y * std::sin(kEdgeTurn_rad) < shift ? 1 : 0;
    }
  return static_cast<double>(covered) / (kGrid * kGrid);
}

// Interrupts a line where it jumps by more than half the unambiguous range.
void AddUnbroken(Series& line, double x, double y, double jump) {
  if (!line.y.empty() && std::abs(line.y.back() - y) > jump) line.Add(x, std::nan(""));
  line.Add(x, y);
}

}  // namespace

Figure Flying(const StudyCamera& of) {
  constexpr double kNear_m = 1.0, kNearAlbedo = 0.1, kFarAlbedo = 0.9, kHalf_m = 10.0;
  const StudyCamera camera = OnePixel(of);
  const double wrap_m = UnambiguousRange_m(camera.settings);
  Panel range{.x = {"share of the pixel that the near surface covers"}, .y = {"measured range [m]"}};
  Panel size{.x = {"share of the pixel that the near surface covers"},
             .y = {"amplitude, relative to the near surface alone"}};
  int color = 0;
  for (const double apart_m : {1.0, 3.0, 5.0}) {
    const double far_m = kNear_m + apart_m;
    Series law{.name = fmt::format("phasor sum, {:g} m apart", apart_m), .color = color}, amplitude = law;
    Series dots{.name = "samples", .dots = true, .color = color++}, amplitude_dots = dots;
    const Phasor near = Return(camera, kNearAlbedo, kNear_m), far = Return(camera, kFarAlbedo, far_m);
    for (const double a : Steps(0.0, 1.0, 400)) {
      const Phasor sum = a * near + (1.0 - a) * far;
      AddUnbroken(law, a, RangeOfSum_m(camera, sum), 0.5 * wrap_m);
      amplitude.Add(a, std::abs(sum) / std::abs(near));
    }
    for (const double shift : Steps(-0.64, 0.64, 41)) {
      // The near half plane, rotated about the axis; its edge is this share of a pixel from the middle.
      const double edge_m = shift * kNear_m / camera.sheet.camera.fx_px - kHalf_m;
      const Stage stage = BuildStage(fmt::format("<geom type='box' size='.0005 {0} {0}' pos='{1} {2} {3}' euler='{4} 0 "
                                                 "0'/><geom type='box' size='.05 30 30' pos='{5} 0 0'/>",
                                                 kHalf_m, kNear_m + 0.0005, -edge_m * std::cos(kEdgeTurn_rad),
                                                 -edge_m * std::sin(kEdgeTurn_rad), kEdgeTurn_rad, far_m + 0.05),
                                     {{.nir_albedo = kNearAlbedo}, {.nir_albedo = kFarAlbedo}});
      const Measurement frame = OneFrame(camera, Only({&sim::TofEffects::flying}), stage.View());
      const double a = CoveredShare(shift);
      dots.Add(a, frame.last.range_m[0]);
      amplitude_dots.Add(a, frame.last.amplitude[0] /
                                (camera.sheet.LampAmplitude_e_m2(camera.settings) * kNearAlbedo / (kNear_m * kNear_m)));
    }
    range.series.push_back(law);
    range.series.push_back(dots);
    size.series.push_back(amplitude);
    size.series.push_back(amplitude_dots);
  }
  return {"flying pixels: two surfaces in one pixel",
          fmt::format("near: {:g} m, albedo {:g}; far: albedo {:g}; {:g} MHz, half the unambiguous range is {:.2f} m",
                      kNear_m, kNearAlbedo, kFarAlbedo, camera.settings.frequency_hz * 1e-6, 0.5 * wrap_m),
          {range, size}};
}

Figure Glass(const StudyCamera& of) {
  constexpr double kPane_m = 1.0, kWall_m = 3.0, kDirt = 0.02, kAlbedo = 0.5, kTransmission = 0.9, kIndex = 1.52;
  const StudyCamera camera = OnePixel(of);
  Series law{.name = "Fresnel's returns", .color = 0}, dots{.name = "samples", .dots = true, .color = 0};
  Series pass = law, pass_dots = dots;
  const double alone_e = camera.sheet.LampAmplitude_e_m2(camera.settings) * kAlbedo / (kWall_m * kWall_m);
  const auto sum_at = [&](double angle_rad) {
    // Each polarisation: reflectance R of a face, of a slab 2R / (1 + R), through it (1 - R) / (1 + R).
    const double cos_i = std::cos(angle_rad), sin_t = std::sin(angle_rad) / kIndex,
                 cos_t = std::sqrt(1.0 - sin_t * sin_t);
    const double s = (cos_i - kIndex * cos_t) / (cos_i + kIndex * cos_t),
                 p = (kIndex * cos_i - cos_t) / (kIndex * cos_i + cos_t);
    const double through =
        0.5 * ((1 - s * s) / (1 + s * s) + (1 - p * p) / (1 + p * p)) * std::pow(kTransmission, 1.0 / cos_t);
    Phasor sum = Return(camera, kDirt * cos_i, kPane_m) + through * through * Return(camera, kAlbedo, kWall_m);
    const double cos_mirrored = -std::cos(2.0 * angle_rad);  // beyond 45 degrees the mirrored ray meets the wall, too
    if (cos_mirrored > 0.0) {
      const double mirrored = s * s / (1 + s * s) + p * p / (1 + p * p);
      sum += mirrored * mirrored * Return(camera, kAlbedo * cos_mirrored, kPane_m + (kWall_m - kPane_m) / cos_mirrored);
    }
    return sum;
  };
  const double degree = std::numbers::pi / 180.0;
  for (const double angle_deg : Steps(0.0, 80.0, 200)) {
    const Phasor sum = sum_at(angle_deg * degree);
    law.Add(angle_deg, RangeOfSum_m(camera, sum));
    pass.Add(angle_deg, std::abs(sum) * kWall_m * kWall_m / kAlbedo);
  }
  for (const double angle_deg : Steps(8.0, 80.0, 25)) {  // the lamp's mirror image glares below 8 degrees
    const double turn_rad = angle_deg * degree;
    const Stage stage = BuildStage(
        fmt::format("<geom type='box' size='.003 3 3' pos='{} {} 0' euler='0 0 {}'/><geom type='box' size='.05 20 20' "
                    "pos='{} 0 0'/>",
                    kPane_m + 0.003 * std::cos(turn_rad), 0.003 * std::sin(turn_rad), turn_rad, kWall_m + 0.05),
        {{.nir_albedo = kDirt, .glass_transmission = kTransmission}, {.nir_albedo = kAlbedo}});
    const Measurement frame = OneFrame(camera, Only({&sim::TofEffects::glass}), stage.View());
    dots.Add(angle_deg, frame.last.range_m[0]);
    pass_dots.Add(angle_deg, frame.last.amplitude[0] / alone_e);
  }
  return {
      "a glass pane before a wall",
      fmt::format(
          "pane at {:g} m (diffuse dirt {:g}, transmission {:g}, index {:g}), wall at {:g} m, albedo {:g}; {:g} MHz",
          kPane_m, kDirt, kTransmission, kIndex, kWall_m, kAlbedo, camera.settings.frequency_hz * 1e-6),
      {{.x = {"angle of incidence on the pane [deg]"}, .y = {"measured range [m]"}, .series = {law, dots}},
       {.x = {"angle of incidence on the pane [deg]"},
        .y = {"amplitude, relative to the wall alone"},
        .series = {pass, pass_dots}}}};
}

}  // namespace merlin::study
