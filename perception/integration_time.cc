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

}  // namespace

DepthSettings Adapt(const DepthFrame& frame, const DepthCameraSheet& sheet, double rate_hz,
                    const IntegrationConfig& config) {
  // The fuller tap holds (1 + C) N / 2, the amplitude is C N.
  const double contrast = sheet.Contrast(frame.settings.frequency_hz);
  const double full_e = 2.0 * contrast / (1.0 + contrast) * sheet.full_well_e;
  DepthSettings settings = frame.settings;
  const auto mean_e = MeanAmplitude_e(frame, config.saturated_weight * full_e);
  if (!mean_e) return settings;

  const double target_e = config.target_share * full_e;
  const double dev = std::clamp((target_e - *mean_e) / target_e, -config.step_max, config.step_max);
  if (std::abs(dev) >= config.dead_band) settings.integration_s *= 1.0 + dev;

  const double fits_s = 1.0 / (rate_hz * settings.sub_frames()) - sheet.readout_s;
  const double longest_s = std::clamp(fits_s, sheet.integration_min_s, sheet.integration_max_s);
  settings.integration_s = std::clamp(settings.integration_s, sheet.integration_min_s, longest_s);
  return settings;
}

}  // namespace merlin
