// Studies of range noise, and of what determines it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/camera/study_parts.h"

namespace merlin::study {
namespace {

constexpr int kPatch = 16, kFrames = 40;  // 10,240 samples per dot, with a standard error of 0.7 %
constexpr double kWall_m = 10.0;          // where the wall stands; the camera moves

StudyCamera Patch(StudyCamera camera, double integration_s) {
  camera.sheet = Cropped(camera.sheet, kPatch, kPatch);
  camera.settings.integration_s = integration_s;
  camera.settings.second_frequency_hz = 0.0;
  return camera;
}

Measurement At(const StudyCamera& camera, const sim::TofEffects& effects, Stage& wall, double distance_m) {
  wall.T_world_optical.translation().x() = kWall_m - distance_m;
  return Measure(ShootingOf(camera, effects, kFrames), wall.View(), std::atomic<bool>(false));
}

std::vector<double> ValidOf(const DepthCameraSheet& sheet, std::vector<double> integration_s) {
  std::erase_if(integration_s, [&](double s) { return s < sheet.integration_min_s || s > sheet.integration_max_s; });
  if (integration_s.empty()) integration_s = {sheet.integration_min_s, sheet.integration_max_s};
  return integration_s;
}

double FullestTap_e(const StudyCamera& camera, double signal_e) {
  return 0.5 * (1.0 + camera.sheet.Contrast(camera.settings.frequency_hz)) * signal_e;
}

std::string SettingsText(const StudyCamera& camera) {
  return fmt::format("{:g} MHz", camera.settings.frequency_hz * 1e-6);
}

}  // namespace

Figure Noise(const StudyCamera& of) {
  constexpr double kAlbedo = 0.5;
  Panel panel{.x = {"distance [m]", true}, .y = {"sigma of range [mm]", true}};
  Stage wall = WallStage({.distance_m = kWall_m, .albedo = kAlbedo});
  const double farthest_m = std::min(7.0, 0.93 * UnambiguousRange_m(of.settings.frequency_hz));
  int color = 0;
  for (const double integration_s : ValidOf(of.sheet, {100e-6, 1000e-6, 5000e-6})) {
    const StudyCamera camera = Patch(of, integration_s);
    Series law{.name = fmt::format("law, T = {:g} us", integration_s * 1e6), .color = color};
    Series dots{.name = "samples", .dots = true, .color = color++};
    for (const double d : LogSteps(0.5, farthest_m, 60))
      law.Add(d, 1e3 * SigmaLaw_m(camera, Signal_e(camera, kAlbedo, 1.0, d), 0.0));
    for (const double d : LogSteps(0.5, farthest_m, 12))
      dots.Add(d, 1e3 * At(camera, Only({&sim::TofEffects::noise}), wall, d).whole.sigma_m.value_or(std::nan("")));
    panel.series.push_back(law);
    panel.series.push_back(dots);
  }
  return {"noise of range over distance",
          fmt::format("albedo {}, {}, no full well; {} samples a dot", kAlbedo, SettingsText(of),
                      kPatch * kPatch * kFrames),
          {panel}};
}

Figure Integration(const StudyCamera& of) {
  struct Target {
    const char* name;
    double distance_m, albedo;
  };
  Panel sigma{.x = {"integration time [us]", true}, .y = {"sigma of range [mm]", true}};
  Panel full{.x = {"integration time [us]", true}, .y = {"share of saturated pixels"}};
  int color = 0;
  for (const Target& target :
       {Target{"book, 0.6 m, albedo 0.8", 0.6, 0.8}, Target{"chair, 3.5 m, albedo 0.4", 3.5, 0.4}}) {
    Stage wall = WallStage({.distance_m = kWall_m, .albedo = target.albedo});
    Series law{.name = std::string("law: ") + target.name, .color = color};
    Series well{.name = law.name, .color = color};
    Series dots{.name = "samples", .dots = true, .color = color};
    Series clipped{.name = "samples, saturated", .dots = true, .color = color + 2};
    Series share{.name = "samples", .dots = true, .color = color++};
    for (const double t : LogSteps(of.sheet.integration_min_s, of.sheet.integration_max_s, 200)) {
      const StudyCamera camera = Patch(of, t);
      const double signal_e = Signal_e(camera, target.albedo, 1.0, target.distance_m);
      const bool fits = FullestTap_e(camera, signal_e) <= of.sheet.full_well_e;
      law.Add(t * 1e6, fits ? 1e3 * SigmaLaw_m(camera, signal_e, 0.0) : std::nan(""));
      // The fullest tap depends on the phase. It holds up to (1 + C) / 2; at this distance, with max |cos|, |sin| of
      // the phase.
      const double phase = Phase_rad(camera, target.distance_m);
      const double modulation = camera.sheet.Contrast(camera.settings.frequency_hz) *
                                std::max(std::abs(std::cos(phase)), std::abs(std::sin(phase)));
      well.Add(t * 1e6, 0.5 * (1.0 + modulation) * signal_e > of.sheet.full_well_e ? 1.0 : 0.0);
    }
    for (const double t : LogSteps(of.sheet.integration_min_s, of.sheet.integration_max_s, 16)) {
      const auto effects = Only({&sim::TofEffects::noise, &sim::TofEffects::saturation});
      const Measurement m = At(Patch(of, t), effects, wall, target.distance_m);
      (m.saturated_share < 0.01 ? dots : clipped).Add(t * 1e6, 1e3 * m.whole.sigma_m.value_or(std::nan("")));
      share.Add(t * 1e6, m.saturated_share);
    }
    for (const Series& series : {law, dots, clipped}) sigma.series.push_back(series);
    full.series.push_back(well);
    full.series.push_back(share);
  }
  return {"a near book and a far chair over integration time",
          SettingsText(of) + ", the law ends where a tap may be full",
          {sigma, full}};
}

Figure SunStudy(const StudyCamera& of) {
  constexpr double kAlbedo = 0.5;
  const StudyCamera camera = Patch(of, of.settings.integration_s);
  Panel panel{.x = {"sunlight on the wall [W/m2/nm]", true}, .y = {"sigma of range [mm]", true}};
  int color = 0;
  for (const double d : {1.0, 2.0, 4.0}) {
    Stage wall = WallStage({.distance_m = kWall_m, .albedo = kAlbedo});
    Series law{.name = fmt::format("law, {:g} m", d), .color = color};
    Series dots{.name = "samples", .dots = true, .color = color++};
    const double signal_e = Signal_e(camera, kAlbedo, 1.0, d);
    // Light of sun and lamp takes the same path from the wall to the pixel: N_b / N_s = E dlambda d^2 / I.
    const auto background_e = [&](double sun) {
      return signal_e * sun * camera.errors.filter_nm * d * d / camera.errors.lamp_w_per_sr;
    };
    for (const double sun : LogSteps(1e-3, 1.0, 60))
      law.Add(sun, 1e3 * SigmaLaw_m(camera, signal_e, background_e(sun)));
    for (const double sun : LogSteps(1e-3, 1.0, 13)) {
      wall.surroundings.ambient_w_m2_nm = sun;
      const auto effects = Only({&sim::TofEffects::noise, &sim::TofEffects::sunlight});
      dots.Add(sun, 1e3 * At(camera, effects, wall, d).whole.sigma_m.value_or(std::nan("")));
    }
    panel.series.push_back(law);
    panel.series.push_back(dots);
  }
  return {"noise of range in sunlight",
          fmt::format("albedo {}, T = {:g} us, {}; neither full well nor background suppression", kAlbedo,
                      camera.settings.integration_s * 1e6, SettingsText(of)),
          {panel}};
}

}  // namespace merlin::study
