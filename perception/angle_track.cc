#include "perception/angle_track.h"

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

constexpr Duration kKept = std::chrono::seconds(1);

double Rate_rad_s(const PanState& from, const PanState& to) {
  return (to.angle_rad - from.angle_rad) / Seconds(to.stamp - from.stamp);
}

// At the middle of three readings: the harmonic mean of the rates on both sides, zero at rest and where it turns back.
double RateAt_rad_s(const PanState& before, const PanState& at, const PanState& after) {
  const double in = Rate_rad_s(before, at), out = Rate_rad_s(at, after);
  if (in * out <= 0.0) return 0.0;
  const double in_s = Seconds(at.stamp - before.stamp), out_s = Seconds(after.stamp - at.stamp);
  const double in_weight = in_s + 2.0 * out_s, out_weight = 2.0 * in_s + out_s;
  return (in_weight + out_weight) / (in_weight / in + out_weight / out);
}

}  // namespace

void AngleTrack::Add(const PanState& state) {
  if (!std::isfinite(state.angle_rad) || (!states_.empty() && state.stamp <= states_.back().stamp)) return;
  states_.push_back(state);
  while (states_.front().stamp + kKept < state.stamp) states_.pop_front();
}

std::optional<double> AngleTrack::At(Time time) const {
  if (states_.empty()) return std::nullopt;
  const auto after = std::ranges::lower_bound(states_, time, {}, &PanState::stamp);
  if (after == states_.end()) return states_.back().angle_rad;
  if (after == states_.begin()) return after->angle_rad;
  const auto before = std::prev(after);
  const double span_s = Seconds(after->stamp - before->stamp), share = Seconds(time - before->stamp) / span_s;
  const double rate = Rate_rad_s(*before, *after);
  const bool first = before == states_.begin(), last = std::next(after) == states_.end();
  const double begin = first ? rate : RateAt_rad_s(*std::prev(before), *before, *after);
  const double end = last ? rate : RateAt_rad_s(*before, *after, *std::next(after));
  // A straight line, and what the rates at both ends differ from its own.
  return std::lerp(before->angle_rad, after->angle_rad, share) +
         span_s * share * (1.0 - share) * ((1.0 - share) * (begin - rate) - share * (end - rate));
}

}  // namespace merlin
