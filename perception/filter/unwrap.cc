#include "perception/filter/unwrap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace merlin {
namespace {

constexpr double kScarce = 0.25;         // share of the picture's pixels
constexpr double kOrderMax = 1.0;        // ranges up to 2U: farther surfaces are too oblique or too dark to follow
constexpr float kAmplitudeRatio = 2.0f;  // between neighbours on one surface

class Growth {
 public:
  Growth(DepthFrame& frame, std::vector<Rejection>& reasons, double lamp_amplitude_e_m2,
         const DepthFilterConfig& config)
      : frame_(frame),
        reasons_(reasons),
        unambiguous_m_(UnambiguousRange_m(frame.settings)),
        brightest_e_m2_(config.ghost_albedo * lamp_amplitude_e_m2),
        config_(config) {}

  void Spread() {
    std::vector<int> front;
    for (int i = 0; i < static_cast<int>(reasons_.size()); ++i)
      if (IsKnown(i)) front.push_back(i);
    for (std::size_t next = 0; next < front.size(); ++next) {
      const int v = front[next] / frame_.width, u = front[next] % frame_.width;
      for (const auto& [dv, du] : {std::pair(0, -1), {0, 1}, {-1, 0}, {1, 0}}) {
        if (!IsInside(v + dv, u + du)) continue;
        const int beside = (v + dv) * frame_.width + u + du;
        if (Joins(front[next], beside)) front.push_back(beside);
      }
    }
  }

 private:
  bool IsInside(int v, int u) const { return v >= 0 && v < frame_.height && u >= 0 && u < frame_.width; }
  bool IsKnown(int pixel) const { return reasons_[static_cast<std::size_t>(pixel)] == Rejection::kNone; }
  double Range_m(int pixel) const { return frame_.range_m[static_cast<std::size_t>(pixel)]; }
  float Amplitude_e(int pixel) const { return frame_.amplitude[static_cast<std::size_t>(pixel)]; }

  // The range of a ghost if it continues the surface of a pixel whose range is known.
  std::optional<double> Continued_m(int known, int ghost) const {
    const double order = std::round((Range_m(known) - Range_m(ghost)) / unambiguous_m_);
    const double range_m = Range_m(ghost) + order * unambiguous_m_;
    const float darker_e = std::min(Amplitude_e(known), Amplitude_e(ghost)),
                brighter_e = std::max(Amplitude_e(known), Amplitude_e(ghost));
    const bool fits = order >= 0.0 && order <= kOrderMax && brighter_e <= kAmplitudeRatio * darker_e &&
                      std::abs(range_m - Range_m(known)) <= Agreement_m(Range_m(known), config_) &&
                      Amplitude_e(ghost) * range_m * range_m <= brightest_e_m2_;
    return fits ? std::optional(range_m) : std::nullopt;
  }

  bool Joins(int known, int pixel) {
    if (reasons_[static_cast<std::size_t>(pixel)] != Rejection::kGhost) return false;
    const auto range_m = Continued_m(known, pixel);
    if (!range_m) return false;
    const int v = pixel / frame_.width, u = pixel % frame_.width;
    int agreeing = 0;
    for (int dv = -1; dv <= 1; ++dv)
      for (int du = -1; du <= 1; ++du) {
        const int other = (v + dv) * frame_.width + u + du;
        agreeing += IsInside(v + dv, u + du) && IsKnown(other) && Continued_m(other, pixel) == range_m;
      }
    if (agreeing < config_.neighbours_min) return false;
    frame_.range_m[static_cast<std::size_t>(pixel)] = static_cast<float>(*range_m);
    reasons_[static_cast<std::size_t>(pixel)] = Rejection::kNone;
    return true;
  }

  DepthFrame& frame_;
  std::vector<Rejection>& reasons_;
  double unambiguous_m_, brightest_e_m2_;
  const DepthFilterConfig& config_;
};

}  // namespace

void UnwrapGhosts(DepthFrame& frame, std::vector<Rejection>& reasons, double lamp_amplitude_e_m2,
                  const DepthFilterConfig& config) {
  const auto known = std::ranges::count(reasons, Rejection::kNone);
  if (static_cast<double>(known) < kScarce * static_cast<double>(reasons.size()))
    Growth(frame, reasons, lamp_amplitude_e_m2, config).Spread();
}

}  // namespace merlin
