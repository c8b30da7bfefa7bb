#include "slam/place_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/map/keyframe_grid.h"

namespace merlin {
namespace {

constexpr double kOtherPlace_m = 0.5, kOtherPlace_rad = 0.3;  // what is farther apart is not the same place

bool IsSamePlace(const Pose& a, const Pose& b, double within_m, double within_rad) {
  const Pose apart = a.inverse() * b;
  return apart.translation().head<2>().norm() < within_m && std::abs(Yaw(apart)) < within_rad;
}

}  // namespace

PlaceSearch::PlaceSearch(SavedMap former, const SlamConfig& config)
    : former_(std::move(former)), config_(config), plan_(GridOf(former_.keyframes, config.occupancy)) {}

bool PlaceSearch::IsDue(const Pose& T_map_base) const {
  return !T_map_searched_ ||
         !IsSamePlace(*T_map_searched_, T_map_base, config_.search.every_m, config_.search.every_rad);
}

std::vector<Loop> PlaceSearch::Verified(std::span<const Point> points_base, std::optional<double> yaw_rad) const {
  const double path_m = former_.keyframes.back().path_m + config_.loop.apart_m;  // all of them are an earlier visit
  LoopConfig loop_config = config_.loop;
  loop_config.turn_rad = 3.2;  // the earlier run may have come the other way
  std::vector<Loop> places;
  for (const PlanMatch& match : plan_.Match(points_base, config_.occupancy)) {
    if (yaw_rad && former_.heading_turn_rad) {
      const double off_rad = WrapPi(Yaw(match.T_map_base) - *yaw_rad - *former_.heading_turn_rad);
      if (std::abs(off_rad) > config_.search.heading_rad) continue;
    }
    if (auto loop = FindLoop(former_.keyframes, points_base, match.T_map_base, path_m, loop_config))
      places.push_back(*std::move(loop));
  }
  return places;
}

std::optional<Loop> PlaceSearch::Search(std::span<const Point> points_base, const Pose& T_map_base,
                                        std::optional<double> yaw_rad) {
  T_map_searched_ = T_map_base;
  const std::optional<Pose> before = std::exchange(T_former_map_, std::nullopt);
  const std::vector<Loop> places = Verified(points_base, yaw_rad);
  const auto is_first = [&](const Loop& place) {
    return IsSamePlace(places.front().T_map_base, place.T_map_base, kOtherPlace_m, kOtherPlace_rad);
  };
  if (places.empty() || !std::ranges::all_of(places, is_first)) {
    agreeing_ = 0;
    return std::nullopt;
  }
  const Pose& T_former_base = places.front().T_map_base;
  const double agreeing = config_.search.agreeing_m;
  const bool agrees = before && IsSamePlace(*before * T_map_base, T_former_base, agreeing, agreeing);
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  T_former_map_ = T_former_base * T_map_base.inverse();
  return agreeing_ >= config_.search.agreeing_min ? std::optional(places.front()) : std::nullopt;
}

}  // namespace merlin
