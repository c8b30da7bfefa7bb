#include "sim/tof/decode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace merlin::sim {
namespace {

double Wrapped(double range_m, double period_m) {
  const double wrapped = range_m - period_m * std::floor(range_m / period_m);
  return wrapped < period_m ? wrapped : 0.0;
}

// Rounding may turn a range just below the wrap into the wrap itself.
float BelowWrap(double range_m, double period_m) {
  const float range = static_cast<float>(range_m);
  return range < period_m ? range : std::nextafter(static_cast<float>(period_m), 0.0f);
}

}  // namespace

Decoder::Decoder(const DepthCameraSheet& sheet, const DepthSettings& settings, const FixedPattern& pattern,
                 std::span<const WigglingCorrection> corrections, const Drift& drift)
    : pattern_(pattern),
      settings_(settings),
      width_(sheet.camera.width),
      height_(sheet.camera.height),
      read_noise_e_(sheet.read_noise_e),
      full_well_e_(sheet.full_well_e),
      low_signal_e_(sheet.low_signal_amplitude_e),
      known_drift_m_(drift.known_m),
      unambiguous_m_(UnambiguousRange_m(settings)) {
  for (const double frequency_hz : {settings.frequency_hz, settings.second_frequency_hz}) {
    if (frequency_hz <= 0.0) continue;
    const auto found = std::ranges::find(corrections, frequency_hz, &WigglingCorrection::frequency_hz);
    waves_.push_back({frequency_hz, UnambiguousRange_m(frequency_hz), found == corrections.end() ? nullptr : &*found});
  }
}

DepthFrame Decoder::EmptyFrame(Time stamp, std::uint64_t index) const {
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  const std::size_t images = settings_.phase_images ? 2 * static_cast<std::size_t>(settings_.sub_frames()) : 0;
  return {.stamp = stamp,
          .index = index,
          .settings = settings_,
          .width = width_,
          .height = height_,
          .range_m = std::vector<float>(pixels),
          .amplitude = std::vector<float>(pixels),
          .intensity = std::vector<std::uint8_t>(pixels),
          .flags = std::vector<std::uint8_t>(pixels),
          .phase_images = std::vector<float>(images * pixels)};
}

double Decoder::Range_m(double phase_rad, const Wave& wave, double known_m) const {
  if (wave.correction != nullptr) phase_rad -= (*wave.correction)(phase_rad);
  return Wrapped(phase_rad / (2.0 * std::numbers::pi) * wave.period_m - known_m, wave.period_m);
}

void Decoder::Decode(std::span<const Taps> taps, bool lit, std::size_t pixel, DepthFrame& frame) const {
  const std::size_t pixels = frame.size();
  double collected_e = 0.0;
  bool saturated = false, suppressed = false, inconsistent = false;
  for (std::size_t k = 0; k < taps.size(); ++k) {
    collected_e += taps[k].a_e + taps[k].b_e;
    saturated |= taps[k].saturated;
    suppressed |= taps[k].suppressed_e > 0.0;
    if (!settings_.phase_images) continue;
    frame.phase_images[2 * k * pixels + pixel] = static_cast<float>(taps[k].a_e);
    frame.phase_images[(2 * k + 1) * pixels + pixel] = static_cast<float>(taps[k].b_e);
  }
  std::array<WrappedRange, 2> ranges{};
  double amplitude_e = 0.0;
  const double known_m = pattern_.known_m[pixel] + known_drift_m_;
  for (std::size_t f = 0; f < waves_.size(); ++f) {
    const PhaseReading reading = DecodePhase(taps.data() + 4 * f);
    if (f == 0) amplitude_e = reading.amplitude_e;
    inconsistent |= Inconsistent(taps.data() + 4 * f, reading.amplitude_e, read_noise_e_);
    ranges[f] = WrappedRange{Range_m(reading.phase_rad, waves_[f], known_m), waves_[f].period_m,
                             std::pow(waves_[f].frequency_hz * reading.amplitude_e, 2)};
  }
  const double range_m = waves_.size() == 1 ? ranges[0].range_m : Unwrap_m(ranges[0], ranges[1], unambiguous_m_);
  const double tap_mean_e = collected_e / (2.0 * static_cast<double>(taps.size()));
  frame.range_m[pixel] = lit ? BelowWrap(range_m, unambiguous_m_) : 0.0f;
  frame.amplitude[pixel] = static_cast<float>(amplitude_e);
  frame.intensity[pixel] =
      static_cast<std::uint8_t>(std::clamp(std::round(255.0 * tap_mean_e / full_well_e_), 0.0, 255.0));
  frame.flags[pixel] = static_cast<std::uint8_t>(
      (lit ? 0 : kInvalid) | (saturated ? kSaturated : 0) | (inconsistent ? kInconsistent : 0) |
      (amplitude_e < low_signal_e_ ? kLowSignal : 0) | (suppressed ? kSbiActive : 0));
}

double Unwrap_m(const WrappedRange& first, const WrappedRange& second, double unambiguous_m) {
  const int first_periods = static_cast<int>(std::lround(unambiguous_m / first.period_m));
  const int second_periods = static_cast<int>(std::lround(unambiguous_m / second.period_m));
  double best_m = HUGE_VAL, range_m = 0.0;
  const double weights = first.weight + second.weight;
  const double share = weights > 0.0 ? second.weight / weights : 0.5;
  for (int i = 0; i < first_periods; ++i) {
    for (int j = 0; j < second_periods; ++j) {
      const double a_m = first.range_m + i * first.period_m, b_m = second.range_m + j * second.period_m;
      const double apart_m = std::remainder(b_m - a_m, unambiguous_m);  // near 0 and near the end are neighbours
      if (std::abs(apart_m) >= best_m) continue;
      best_m = std::abs(apart_m);
      range_m = Wrapped(a_m + share * apart_m, unambiguous_m);
    }
  }
  return range_m;
}

void PostProcess(DepthFrame& frame) {
  for (std::size_t i = 0; i < frame.size(); ++i)
    if (frame.flags[i] & (kInvalid | kLowSignal)) frame.flags[i] |= kInvalid, frame.range_m[i] = 0.0f;
  const std::vector<float> before = frame.range_m;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v * frame.width + u);
      if (frame.flags[i] & kInvalid) continue;
      std::vector<float> around;
      for (int b = std::max(0, v - 1); b <= std::min(frame.height - 1, v + 1); ++b)
        for (int a = std::max(0, u - 1); a <= std::min(frame.width - 1, u + 1); ++a) {
          const std::size_t j = static_cast<std::size_t>(b * frame.width + a);
          if (!(frame.flags[j] & kInvalid)) around.push_back(before[j]);
        }
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>((around.size() - 1) / 2);
      std::ranges::nth_element(around, middle);
      frame.range_m[i] = *middle;
    }
  }
}

}  // namespace merlin::sim
