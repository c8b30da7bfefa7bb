// Studies of phase errors on a single surface: harmonics, and motion between the sub-frames.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tools/camera/study_parts.h"

namespace merlin::study {
namespace {

constexpr double kFarWall_m = 12.0;

// Measured minus true range at this distance from the wall.
double Error_m(const StudyCamera& camera, const sim::TofEffects& effects, Stage& wall, double distance_m,
               double speed_away_m_s) {
  wall.T_world_optical.translation().x() = kFarWall_m - distance_m;
  const Measurement frame = OneFrame(camera, effects, wall.View({-speed_away_m_s, 0.0, 0.0}));
  return UnwrapNear(MiddleRange_m(frame) - distance_m, 0.0, UnambiguousRange_m(camera.settings));
}

}  // namespace

Figure Wiggling(const StudyCamera& of) {
  const StudyCamera camera = OnePixel(of);
  const double wrap_m = UnambiguousRange_m(camera.settings);
  Stage wall = WallStage({.distance_m = kFarWall_m});
  Series law{.name = "closed form", .color = 0};
  Series raw{.name = "before calibration", .dots = true, .color = 0},
      rest{.name = "after calibration", .dots = true, .color = 1};
  // Four samples leave -(a3 - a5) sin(4 phi) of the odd harmonics, to first order.
  const double size_rad = camera.errors.harmonic_3 - camera.errors.harmonic_5;
  for (const double d : Steps(0.02, wrap_m, 300))
    law.Add(d, -1e3 * RangeOf_m(camera, size_rad * std::sin(4.0 * Phase_rad(camera, d))));
  for (const double d : Steps(0.02, wrap_m - 0.02, 90)) {
    raw.Add(d, 1e3 * Error_m(camera, Only({&sim::TofEffects::wiggling}, false), wall, d, 0.0));
    rest.Add(d, 1e3 * Error_m(camera, Only({&sim::TofEffects::wiggling}, true), wall, d, 0.0));
  }
  return {"wiggling: range error over distance",
          fmt::format("{:g} MHz, a3 = {:g}, a5 = {:g}; period a quarter of the unambiguous {:.3f} m",
                      camera.settings.frequency_hz * 1e-6, camera.errors.harmonic_3, camera.errors.harmonic_5, wrap_m),
          {{.x = {"distance [m]"}, .y = {"measured less true range [mm]"}, .series = {law, raw, rest}}}};
}

// The sum of four sub-frames of a wall that moves away: each sub-frame has its own phase and its own light, ~ 1 / d^2.
// Far away, where the light hardly changes, the error is (v Dt / 2) cos 2 phi.
double MovingError_m(const StudyCamera& camera, double range_m, double speed_m_s, double step_s) {
  double D[4];
  for (int k = 0; k < 4; ++k) {
    const double at_m = range_m + (k - 1.5) * step_s * speed_m_s;
    D[k] = std::cos(Phase_rad(camera, at_m) + 0.5 * k * std::numbers::pi) / (at_m * at_m);
  }
  const double read_m = RangeOf_m(camera, std::atan2(D[3] - D[1], D[0] - D[2]));
  return std::remainder(read_m - range_m, RangeOf_m(camera, 2.0 * std::numbers::pi));
}

Figure Motion(const StudyCamera& of) {
  const StudyCamera camera = OnePixel(of);
  const double step_s = camera.settings.integration_s + camera.sheet.readout_s;
  Stage wall = WallStage({.distance_m = kFarWall_m});
  Panel panel{.x = {"distance at mid-exposure [m]"}, .y = {"measured less true range [mm]"}};
  int color = 0;
  for (const double speed_m_s : {0.5, 1.0, 2.0}) {
    Series law{.name = fmt::format("four phases by formula, {:g} m/s", speed_m_s), .color = color};
    Series dots{.name = "samples, moving away", .dots = true, .color = color++};
    for (const double d : Steps(0.5, 5.0, 200)) law.Add(d, 1e3 * MovingError_m(camera, d, speed_m_s, step_s));
    for (const double d : Steps(0.5, 5.0, 46))
      dots.Add(d, 1e3 * Error_m(camera, Only({&sim::TofEffects::motion}), wall, d, speed_m_s));
    panel.series.push_back(law);
    panel.series.push_back(dots);
  }
  return {"motion along the axis: range error over distance",
          fmt::format("{:g} MHz, sub-frames {:g} ms apart", camera.settings.frequency_hz * 1e-6, 1e3 * step_s),
          {panel}};
}

}  // namespace merlin::study
