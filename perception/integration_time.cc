#include "perception/integration_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace merlin {
namespace {

// Dark pixels are usable, whatever the camera's own filter says of them: they show that more light is needed.
bool IsUsable(std::uint8_t flags, float amplitude_e) {
  if (!std::isfinite(amplitude_e)) return false;
  return (flags & (kSaturated | kLowSignal)) != 0 || (flags & (kInvalid | kInconsistent)) == 0;
}

// The amplitude of a saturated pixel is not known, only that it is too high: it counts as saturated_e.
std::optional<double> MeanAmplitude_e(const DepthFrame& frame, double saturated_e) {
  double sum_e = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (!IsUsable(frame.flags[i], frame.amplitude[i])) continue;
    sum_e += frame.flags[i] & kSaturated ? saturated_e : frame.amplitude[i];
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum_e / static_cast<double>(count);
}

// Within the data sheet's range; all sub-frames end within one period.
double Fitting_s(double integration_s, const DepthCameraSheet& sheet, const DepthSettings& settings, double rate_hz) {
  const double fits_s = 1.0 / (rate_hz * settings.sub_frames()) - sheet.readout_s;
  const double longest_s = std::clamp(fits_s, sheet.integration_min_s, sheet.integration_max_s);
  return std::clamp(integration_s, sheet.integration_min_s, longest_s);
}

}  // namespace

double FullAmplitude_e(const DepthCameraSheet& sheet, double frequency_hz) {
  const double contrast = sheet.Contrast(frequency_hz);
  return 2.0 * contrast / (1.0 + contrast) * sheet.full_well_e;
}

double StartIntegration_s(const DepthCameraSheet& sheet, const DepthSettings& settings, double rate_hz) {
  constexpr double kAlbedo = 0.8, kRange_m = 1.0;
  const double per_s_e = sheet.LampAmplitude_e_m2(settings) / settings.integration_s * kAlbedo / (kRange_m * kRange_m);
  return Fitting_s(FullAmplitude_e(sheet, settings.frequency_hz) / per_s_e, sheet, settings, rate_hz);
}

DepthSettings Adapt(const DepthFrame& frame, const DepthCameraSheet& sheet, double rate_hz,
                    const IntegrationConfig& config) {
  const double full_e = FullAmplitude_e(sheet, frame.settings.frequency_hz);
  DepthSettings settings = frame.settings;
  const auto mean_e = MeanAmplitude_e(frame, config.saturated_weight * full_e);
  if (!mean_e) return settings;

  const double target_e = config.target_share * full_e;
  const double dev = std::clamp((target_e - *mean_e) / target_e, -config.step_max, config.step_max);
  if (std::abs(dev) >= config.dead_band) settings.integration_s *= 1.0 + dev;

  settings.integration_s = Fitting_s(settings.integration_s, sheet, settings, rate_hz);
  return settings;
}

}  // namespace merlin
