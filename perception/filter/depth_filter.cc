#include "perception/filter/depth_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "perception/filter/unwrap.h"

namespace merlin {
namespace {

Rejection ReasonOfPixel(const DepthFrame& frame, std::size_t i, double lamp_amplitude_e_m2, double unambiguous_m,
                        double ghost_albedo) {
  const std::uint8_t flags = frame.flags[i];
  if (flags & kInvalid || !std::isfinite(frame.range_m[i]) || !(frame.range_m[i] > 0.0f)) return Rejection::kInvalid;
  if (flags & kSaturated) return Rejection::kSaturated;
  if (flags & kInconsistent) return Rejection::kInconsistent;
  if (flags & kLowSignal) return Rejection::kLowSignal;
  if (IsGhost(frame.range_m[i], frame.amplitude[i], lamp_amplitude_e_m2, unambiguous_m, ghost_albedo))
    return Rejection::kGhost;
  return Rejection::kNone;
}

}  // namespace

bool IsGhost(double range_m, double amplitude_e, double lamp_amplitude_e_m2, double unambiguous_m,
             double ghost_albedo) {
  const double implied_albedo = amplitude_e * range_m * range_m / lamp_amplitude_e_m2;
  const double share = range_m / (range_m + unambiguous_m);
  return !(implied_albedo >= ghost_albedo * share * share);
}

FilteredDepth FilterDepth(DepthFrame frame, const DepthCameraSheet& sheet, const DepthFilterConfig& config) {
  const double lamp = sheet.LampAmplitude_e_m2(frame.settings);
  const double unambiguous_m = UnambiguousRange_m(frame.settings);
  FilteredDepth out;
  out.reasons.resize(frame.size());
  for (std::size_t i = 0; i < frame.size(); ++i)
    out.reasons[i] = ReasonOfPixel(frame, i, lamp, unambiguous_m, config.ghost_albedo);
  UnwrapGhosts(frame, out.reasons, lamp, config);

  const std::vector<Rejection> first = out.reasons;
  std::vector<float> median_m = frame.range_m;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * frame.width + u;
      if (first[i] != Rejection::kNone) continue;
      const float range_m = frame.range_m[i];
      const double tolerance_m = Agreement_m(range_m, config);
      std::array<float, 9> agreeing;
      int count = 0;
      for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          if (v + dv < 0 || v + dv >= frame.height || u + du < 0 || u + du >= frame.width) continue;
          const std::size_t j = static_cast<std::size_t>(v + dv) * frame.width + (u + du);
          if (first[j] == Rejection::kNone && std::abs(frame.range_m[j] - range_m) <= tolerance_m)
            agreeing[count++] = frame.range_m[j];
        }
      }
      if (count - 1 < config.neighbours_min) {
        out.reasons[i] = Rejection::kLonely;
        continue;
      }
      std::nth_element(agreeing.begin(), agreeing.begin() + count / 2, agreeing.begin() + count);
      median_m[i] = agreeing[count / 2];
    }
  }
  for (const Rejection reason : out.reasons) ++out.counts[static_cast<std::size_t>(reason)];
  out.frame = std::move(frame);
  out.frame.range_m = std::move(median_m);
  return out;
}

}  // namespace merlin
