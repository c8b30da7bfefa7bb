#include "tools/camera/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"
#include "tools/camera/study_parts.h"

namespace merlin {
namespace {

struct Entry {
  const char* name;
  Figure (*make)(const StudyCamera&);
};
constexpr Entry kStudies[] = {
    {"noise", study::Noise},   {"wiggling", study::Wiggling},   {"integration", study::Integration},
    {"flying", study::Flying}, {"multipath", study::Multipath}, {"scatter", study::Scatter},
    {"sun", study::SunStudy},  {"glass", study::Glass},         {"motion", study::Motion}};

}  // namespace

std::vector<std::string> StudyNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kStudies) names.emplace_back(entry.name);
  return names;
}

void CheckStudyName(const std::string& name) {
  const std::vector<std::string> known = StudyNames();
  if (std::ranges::find(known, name) == known.end())
    throw InputError("--study", "unknown study '" + name + "'",
                     fmt::format("'{}' (known: {})", NearestName(name, known), fmt::join(known, ", ")));
}

Figure Study(const std::string& name, const StudyCamera& camera) {
  CheckStudyName(name);
  Figure figure =
      std::ranges::find(kStudies, name, [](const Entry& entry) { return std::string(entry.name); })->make(camera);
  figure.title = fmt::format("{}: {}", camera.sheet.name, figure.title);
  return figure;
}

namespace study {

sim::TofEffects Only(std::initializer_list<bool sim::TofEffects::*> on, bool calibrated) {
  sim::TofEffects effects = sim::kIdealTof;
  for (const auto effect : on) effects.*effect = true;
  effects.calibrated = calibrated;
  return effects;
}

StudyCamera OnePixel(StudyCamera camera) {
  camera.sheet = Cropped(camera.sheet, 1, 1);
  camera.settings.second_frequency_hz = 0.0;
  return camera;
}

DepthCameraSheet Cropped(DepthCameraSheet sheet, int width, int height) {
  sheet.camera.width = std::min(width, sheet.camera.width);
  sheet.camera.height = std::min(height, sheet.camera.height);
  sheet.camera.cx_px = 0.5 * (sheet.camera.width - 1);
  sheet.camera.cy_px = 0.5 * (sheet.camera.height - 1);
  return sheet;
}

Shooting ShootingOf(const StudyCamera& camera, const sim::TofEffects& effects, int frames) {
  return {camera.sheet, camera.errors, camera.settings, effects, camera.seed, frames, camera.threads};
}

Measurement OneFrame(const StudyCamera& camera, const sim::TofEffects& effects, const sim::TofView& view) {
  return Measure(ShootingOf(camera, effects, 1), view, std::atomic<bool>(false));
}

double MiddleRange_m(const Measurement& frame) { return frame.center.mean_m.value_or(std::nan("")); }

std::vector<double> Steps(double from, double to, int count) {
  std::vector<double> steps;
  for (int i = 0; i < count; ++i) steps.push_back(from + (to - from) * i / (count - 1));
  return steps;
}

std::vector<double> LogSteps(double from, double to, int count) {
  std::vector<double> steps = Steps(std::log(from), std::log(to), count);
  for (double& step : steps) step = std::exp(step);
  return steps;
}

double Signal_e(const StudyCamera& camera, double albedo, double cos_incidence, double range_m) {
  return camera.sheet.signal_e_m2_per_us * albedo * cos_incidence * camera.settings.integration_s * 1e6 /
         (range_m * range_m);
}

double SigmaLaw_m(const StudyCamera& camera, double signal_e, double background_e) {
  const double read_e2 = 2.0 * camera.sheet.read_noise_e * camera.sheet.read_noise_e;
  const double dark_e = camera.errors.dark_e_per_us * camera.settings.integration_s * 1e6;
  return kSpeedOfLight_m_s / (4.0 * std::numbers::sqrt2 * std::numbers::pi * camera.settings.frequency_hz) *
         std::sqrt(signal_e + background_e + dark_e + read_e2) /
         (camera.sheet.Contrast(camera.settings.frequency_hz) * signal_e);
}

double Phase_rad(const StudyCamera& camera, double range_m) {
  return 4.0 * std::numbers::pi * camera.settings.frequency_hz * range_m / kSpeedOfLight_m_s;
}

double RangeOf_m(const StudyCamera& camera, double phase_rad) {
  return phase_rad * kSpeedOfLight_m_s / (4.0 * std::numbers::pi * camera.settings.frequency_hz);
}

}  // namespace study
}  // namespace merlin
