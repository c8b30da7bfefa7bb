#include "scenarios/run/truth.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace merlin {
namespace {

constexpr Duration kEpisodeGap = std::chrono::milliseconds(500);  // contacts closer than this are one collision
constexpr double kStands_m_s = 0.01;

std::string NameOf(std::size_t event) { return std::to_string(event); }

}  // namespace

std::vector<sim::Obstacle> ObstaclesOf(const Scenario& scenario) {
  std::vector<sim::Obstacle> obstacles;
  for (const ObstacleEvent& event : scenario.obstacles)
    obstacles.push_back({NameOf(obstacles.size()), {event.length_m, event.width_m, event.height_m}, event.material});
  return obstacles;
}

Truth::Truth(const Scenario& scenario, const sim::World& world)
    : car_(world, IsOnTurntable(scenario.task)), events_(scenario.obstacles), placed_(events_.size(), false) {
  recent_.push_back({world.Now(), world.T_world_base()});
  if (!events_.empty()) obstacle_stop_s_ = 0.0;
}

void Truth::Watch(sim::World& world) {
  const Time now = world.Now();
  recent_.push_back({now, world.T_world_base()});
  while (recent_.front().stamp + std::chrono::seconds(1) < now) recent_.pop_front();
  state_.Add(std::span<const double>(world.State()));
  if (!world.CarTouches().empty()) {
    if (!last_touch_ || now - *last_touch_ > kEpisodeGap) ++collisions_;
    last_touch_ = now;
  }
  car_.Watch(world);
  WatchObstacles(world);
}

void Truth::WatchObstacles(sim::World& world) {
  const double now_s = Seconds(world.Now());
  bool any = false;
  for (std::size_t i = 0; i < events_.size(); ++i) {
    const ObstacleEvent& event = events_[i];
    const bool present = now_s >= event.appear_s && now_s < event.disappear_s;
    if (present && !placed_[i]) {
      const Pose T_world_base = world.T_world_base();
      const Pose T_world_flat =
          FromXyYaw(T_world_base.translation().x(), T_world_base.translation().y(), Yaw(T_world_base));
      world.PlaceObstacle(NameOf(i), T_world_flat * FromXyYaw(event.ahead_m + 0.5 * event.length_m, event.left_m, 0.0));
    }
    if (!present && placed_[i]) world.RemoveObstacle(NameOf(i));
    placed_[i] = present;
    if (!present) continue;
    any = true;
    obstacle_gap_m_ = std::min(obstacle_gap_m_.value_or(HUGE_VAL), world.ObstacleDistance_m(NameOf(i)));
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
