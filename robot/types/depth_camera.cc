#include "robot/types/depth_camera.h"

#include <algorithm>
#include <cmath>

#include "robot/base/text_fields.h"

namespace merlin {
namespace {

std::string ValidFrequencies_mhz(const DepthCameraSheet& sheet) {
  std::string list;
  for (const double frequency_hz : sheet.frequencies_hz)
    list += (list.empty() ? "" : " or ") + NumberText(frequency_hz * 1e-6);
  return list;
}

void CheckFrequency(const DepthCameraSheet& sheet, double frequency_hz) {
  if (std::ranges::find(sheet.frequencies_hz, frequency_hz) == sheet.frequencies_hz.end())
    throw InputError(sheet.name, "invalid modulation frequency", ValidFrequencies_mhz(sheet) + " MHz",
                     NumberText(frequency_hz * 1e-6) + " MHz");
}

double NearestFrequency_hz(const DepthCameraSheet& sheet, double frequency_hz) {
  return *std::ranges::min_element(sheet.frequencies_hz, {},
                                   [=](double valid_hz) { return std::abs(valid_hz - frequency_hz); });
}

}  // namespace

void CheckSettings(const DepthCameraSheet& sheet, const DepthSettings& settings) {
  if (!(settings.integration_s >= sheet.integration_min_s && settings.integration_s <= sheet.integration_max_s))
    throw InputError(
        sheet.name, "invalid integration time",
        NumberText(sheet.integration_min_s * 1e6) + " to " + NumberText(sheet.integration_max_s * 1e6) + " us",
        NumberText(settings.integration_s * 1e6) + " us");
  CheckFrequency(sheet, settings.frequency_hz);
  if (settings.second_frequency_hz == 0.0) return;
  CheckFrequency(sheet, settings.second_frequency_hz);
  if (settings.second_frequency_hz == settings.frequency_hz)
    throw InputError(sheet.name, "both modulation frequencies are the same", "two that differ",
                     NumberText(settings.frequency_hz * 1e-6) + " MHz twice");
}

DepthSettings NearestSettings(const DepthCameraSheet& sheet, const DepthSettings& settings) {
  if (!std::isfinite(settings.integration_s) || !std::isfinite(settings.frequency_hz) ||
      !std::isfinite(settings.second_frequency_hz))
    CheckSettings(sheet, settings);
  DepthSettings nearest = settings;
  nearest.integration_s = std::clamp(settings.integration_s, sheet.integration_min_s, sheet.integration_max_s);
  nearest.frequency_hz = NearestFrequency_hz(sheet, settings.frequency_hz);
  if (settings.second_frequency_hz != 0.0)
    nearest.second_frequency_hz = NearestFrequency_hz(sheet, settings.second_frequency_hz);
  CheckSettings(sheet, nearest);
  return nearest;
}

}  // namespace merlin
