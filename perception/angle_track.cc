#include "perception/angle_track.h"

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

constexpr Duration kKept = std::chrono::seconds(1);

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
  const double share = Seconds(time - before->stamp) / Seconds(after->stamp - before->stamp);
  return std::lerp(before->angle_rad, after->angle_rad, share);
}

}  // namespace merlin
