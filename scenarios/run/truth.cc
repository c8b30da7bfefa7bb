#include "scenarios/run/truth.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace merlin {
namespace {

constexpr Duration kEpisodeGap = std::chrono::milliseconds(500);  // contacts closer than this are one collision
constexpr double kStands_m_s = 0.01;

}  // namespace

Truth::Truth(const Scenario& scenario, const sim::World& world) : car_(world, IsOnTurntable(scenario.task)) {
  recent_.push_back({world.Now(), world.T_world_base()});
  if (world.actors().size() > 0) obstacle_stop_s_ = 0.0;
}

void Truth::Watch(const sim::World& world) {
  const Time now = world.Now();
  recent_.push_back({now, world.T_world_base()});
  while (recent_.front().stamp + std::chrono::seconds(1) < now) recent_.pop_front();
  state_.Add(std::span<const double>(world.State()));
  if (!world.CarTouches().empty()) {
    if (!last_touch_ || now - *last_touch_ > kEpisodeGap) ++collisions_;
    last_touch_ = now;
  }
  car_.Watch(world);
  WatchActors(world);
}

void Truth::WatchActors(const sim::World& world) {
  constexpr double kFar_m = 10.0;  // larger gaps are not measured
  bool any = false;
  for (std::size_t i = 0; i < world.actors().size(); ++i) {
    if (!world.actors().present(i)) continue;
    any = true;
    obstacle_gap_m_ = world.ActorDistance_m(i, obstacle_gap_m_.value_or(kFar_m));
  }
  standing_s_ = any && std::abs(world.Speed_m_s()) < kStands_m_s ? standing_s_ + Seconds(sim::World::kStep) : 0.0;
  if (obstacle_stop_s_) obstacle_stop_s_ = std::max(*obstacle_stop_s_, standing_s_);
}

void Truth::Keep(Time stamp) {
  const auto after = std::ranges::lower_bound(recent_, stamp, {}, &StampedPose::stamp);
  if (after == recent_.end() || (after == recent_.begin() && after->stamp != stamp)) return;
  if (after->stamp == stamp) return trajectory_.push_back(*after);
  const auto before = std::prev(after);
  const double share = Seconds(stamp - before->stamp) / Seconds(after->stamp - before->stamp);
  trajectory_.push_back({stamp, Interpolate(before->T, after->T, share)});
}

}  // namespace merlin
