#include "slam/place_search.h"

#include <cmath>
#include <utility>

namespace merlin {
namespace {

// A place in a loaded map must fit better than a loop: no odometry speaks for it or against it. Limits from starts in the
// map of corridor_26x21: right places had 0.019-0.025 m and 0.69 or more, and no wrong one kept both in three searches.
constexpr double kOverlapMin = 0.6, kRms_max_m = 0.025, kScoreMin = 0.65;

bool Convinces(const PlaceFound& found) {
  return found.place && found.place->overlap >= kOverlapMin && found.rms_m <= kRms_max_m && found.score >= kScoreMin;
}

bool IsSamePlace(const Pose& a, const Pose& b, double within_m, double within_rad) {
  const Pose apart = a.inverse() * b;
  return apart.translation().head<2>().norm() < within_m && std::abs(Yaw(apart)) < within_rad;
}

}  // namespace

PlaceSearch::PlaceSearch(SavedMap former, const SlamConfig& config)
    : former_(std::move(former)), config_(config), finder_(former_.keyframes, config.loop, config.occupancy) {}

bool PlaceSearch::IsDue(const Pose& T_map_base) const {
  return !T_map_searched_ ||
         !IsSamePlace(*T_map_searched_, T_map_base, config_.search.every_m, config_.search.every_rad);
}

std::optional<Loop> PlaceSearch::Search(std::span<const Point> points_base, const Pose& T_map_base,
                                        std::optional<double> yaw_rad) {
  T_map_searched_ = T_map_base;
  const std::optional<Pose> before = std::exchange(T_former_map_, std::nullopt);
  std::optional<PlanHeading> heading;
  if (yaw_rad && former_.heading_turn_rad)
    heading = {WrapPi(*yaw_rad + *former_.heading_turn_rad), config_.search.heading_rad};
  const PlaceFound found = finder_.Find(former_.keyframes, points_base, {}, heading);
  const std::optional<Loop>& place = found.place;
  if (!Convinces(found)) {
    agreeing_ = 0;
    return std::nullopt;
  }
  const double agreeing = config_.search.agreeing_m;
  const bool agrees = before && IsSamePlace(*before * T_map_base, place->T_map_base, agreeing, agreeing);
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  T_former_map_ = place->T_map_base * T_map_base.inverse();
  return agreeing_ >= config_.search.agreeing_min ? place : std::nullopt;
}

}  // namespace merlin
