#include "perception/exposure_control.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace merlin {
namespace {

constexpr double kFirstShare = 1.0 / 8.0;    // of the long exposure: the first short one
constexpr double kLongestShare = 1.0 / 4.0;  // the longest short one
constexpr double kDarker = 1.0 / 4.0;        // a short exposure that saturates is shortened by this
constexpr double kBrightEnd = 0.995;         // quantile of the amplitudes that a short exposure is made for
constexpr double kBrightShare = 0.5;         // it is brought to this share of a full well
constexpr Duration kKeepsOn = std::chrono::seconds(1);

// The amplitude [e] that only the brightest pixels exceed; 0 without pixels.
double BrightEnd_e(const DepthFrame& frame) {
  std::vector<float> amplitudes;
  for (const float amplitude_e : frame.amplitude)
    if (std::isfinite(amplitude_e)) amplitudes.push_back(amplitude_e);
  if (amplitudes.empty()) return 0.0;
  const auto nth =
      amplitudes.begin() + static_cast<std::ptrdiff_t>(kBrightEnd * static_cast<double>(amplitudes.size() - 1));
  std::ranges::nth_element(amplitudes, nth);
  return *nth;
}

}  // namespace

DepthSettings ExposureControl::After(const DepthFrame& frame) {
  if (!long_s_) long_s_ = frame.settings.integration_s;
  const bool is_short = short_s_ && frame.settings.integration_s < 2.0 * kLongestShare * *long_s_;
  if (is_short) {
    AdaptShort(frame);
  } else {
    if (config_.automatic) long_s_ = Adapt(frame, sheet_, rate_hz_, config_).integration_s;
    if (Saturates(frame)) {
      short_until_ = frame.stamp + kKeepsOn;
      if (!short_s_) short_s_ = std::max(kFirstShare * *long_s_, sheet_.integration_min_s);
    }
  }
  if (frame.stamp > short_until_ || (short_s_ && *short_s_ >= *long_s_)) short_s_.reset();

  short_next_ = short_s_ && !short_next_;
  DepthSettings next = frame.settings;
  next.integration_s = short_next_ ? *short_s_ : *long_s_;
  return next;
}

bool ExposureControl::Saturates(const DepthFrame& frame) const {
  const auto saturated =
      std::ranges::count_if(frame.flags, [](std::uint8_t flags) { return (flags & kSaturated) != 0; });
  return static_cast<double>(saturated) > config_.saturated_share * static_cast<double>(frame.size());
}

void ExposureControl::AdaptShort(const DepthFrame& frame) {
  const double bright_e = BrightEnd_e(frame);
  double factor = kDarker;
  if (!Saturates(frame)) {
    const double target_e = kBrightShare * FullAmplitude_e(sheet_, frame.settings.frequency_hz);
    factor = bright_e > 0.0 ? std::clamp(target_e / bright_e, 0.5, 2.0) : 1.0;
  }
  const double longest_s = std::max(kLongestShare * *long_s_, sheet_.integration_min_s);
  short_s_ = std::clamp(factor * frame.settings.integration_s, sheet_.integration_min_s, longest_s);
}

}  // namespace merlin
