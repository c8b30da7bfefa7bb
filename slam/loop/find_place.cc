#include "slam/loop/find_place.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace merlin {
namespace {

constexpr double kCell_m = 0.1;             // of the floor plan
constexpr double kPlanEvery_m = 0.3;        // distance between the key frames that it is made of
constexpr double kViewsReach_m = 3.0;       // key frames with view centres nearer than this see the place...
constexpr std::size_t kPlaceViewsMax = 15;  // ...the nearest of them are registered against
// Measured in corridor_loop, where each place of one lap was searched in the map of another, with what was seen over 3 m
// and over 5 m. At the true place at most 6 % of the points stood on free ground of the map, and the score was at least
// 0.61. With these limits 13 (3 m) and 17 (5 m) of 19 places are found, and none is wrong. Where the true place was taken
// out of the list, 3 and 2 of 19 were wrong: one search alone cannot tell a foreign place that looks alike.
constexpr double kFreeMax = 0.08;  // share of the points where the map is free
constexpr double kScoreMin = 0.6;  // on the floor plan
// In a region, where the map may show only a part of what is seen, less speaks for a place, and nothing may speak against
// it. At the end of a lap without a compass: at most 0.03, at least 0.38 and 0.94; at a wrong place 0.08, 0.34 and 0.85.
constexpr double kPartFreeMax = 0.04, kPartScoreMin = 0.35, kInlierShareMin = 0.9;
constexpr double kAsGood = 0.85;                  // a fit with this share of the best one's score is as good
constexpr double kAsNear = 1.5;                   // a fit with this multiple of the best one's rms is as good
constexpr double kSame_m = 0.3, kSame_rad = 0.1;  // two fits nearer than this are the same place

OccupancyGrid PlanGrid(std::span<const Keyframe> keyframes, OccupancyConfig heights) {
  heights.cell_m = kCell_m;
  OccupancyGrid grid(heights);
  double last_m = -HUGE_VAL;
  for (const Keyframe& keyframe : keyframes) {
    if (keyframe.path_m - last_m < kPlanEvery_m) continue;
    grid.Insert(keyframe.points_base, keyframe.camera_base, keyframe.T_map_base);
    last_m = keyframe.path_m;
  }
  return grid;
}

// Key frames that see what is seen from this pose, the nearest view first. Also those that look the other way: walls
// are the same from there.
std::vector<std::size_t> ViewsNear(std::span<const Keyframe> keyframes, const Pose& T_map_base) {
  std::vector<std::pair<double, std::size_t>> views;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const double distance_m = (ViewCentre(keyframes[i].T_map_base) - ViewCentre(T_map_base)).norm();
    if (distance_m < kViewsReach_m) views.emplace_back(distance_m, i);
  }
  std::ranges::sort(views);
  const std::size_t stride = views.size() / kPlaceViewsMax + 1;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < views.size(); i += stride) indices.push_back(views[i].second);
  return indices;
}

bool SamePlace(const Pose& a, const Pose& b) {
  const Pose apart = a.inverse() * b;
  return apart.translation().norm() < kSame_m && std::abs(Yaw(apart)) < kSame_rad;
}

}  // namespace

PlaceFinder::PlaceFinder(std::span<const Keyframe> keyframes, const LoopConfig& config, const OccupancyConfig& heights)
    : config_(config), heights_(heights), plan_(PlanGrid(keyframes, heights)) {}

// Share of the points, of those as high as obstacles, that stand where the map knows free ground.
double PlaceFinder::FreeShare(std::span<const Point> points_base, const Pose& T_map_base) const {
  int high = 0, in_free = 0;
  for (const Point& point : points_base) {
    const Eigen::Vector3d p_map = T_map_base * point.position.cast<double>();
    if (p_map.z() < heights_.height_min_m || p_map.z() > heights_.height_max_m) continue;
    ++high;
    in_free += plan_.IsFree(p_map.head<2>());
  }
  return high == 0 ? 0.0 : static_cast<double>(in_free) / high;
}

PlaceFound PlaceFinder::Find(std::span<const Keyframe> keyframes, std::span<const Point> points_base,
                             const std::optional<PlanRegion>& region, const std::optional<PlanHeading>& heading) const {
  struct Candidate {
    std::size_t former = 0;
    PlaceFit fit;
    double score = 0.0;
  };
  PlaceFound search;
  std::vector<Candidate> fits;
  for (const PlanMatch& match : plan_.Match(points_base, heights_, region, heading)) {
    const std::vector<std::size_t> views = ViewsNear(keyframes, match.T_map_base);
    if (views.empty()) continue;
    const PlaceFit fit = FitToViews(keyframes, views, points_base, match.T_map_base, config_);
    const double score = plan_.Score(points_base, heights_, fit.fit.T_map_base);
    const bool fits_shape = fit.fit.converged && fit.fit.rms_m <= config_.rms_max_m && fit.near >= config_.overlap_min;
    if (!fits_shape || score < (region ? kPartScoreMin : kScoreMin)) continue;
    if (region && fit.fit.inlier_share < kInlierShareMin) continue;
    if (FreeShare(points_base, fit.fit.T_map_base) > (region ? kPartFreeMax : kFreeMax)) continue;
    const auto same = [&](const Candidate& other) { return SamePlace(other.fit.fit.T_map_base, fit.fit.T_map_base); };
    if (std::ranges::any_of(fits, same)) continue;
    fits.push_back({views.front(), fit, score});
  }
  if (fits.empty()) return search;
  const auto best = std::ranges::max_element(fits, {}, &Candidate::score);
  // Anywhere in a map, bare walls alike are frequent: there the distances of the points must be alike, too.
  search.fitting = static_cast<int>(std::ranges::count_if(fits, [&](const Candidate& c) {
    return c.score >= kAsGood * best->score && (region || c.fit.fit.rms_m <= kAsNear * best->fit.fit.rms_m);
  }));
  search.rms_m = best->fit.fit.rms_m;
  search.score = best->score;
  if (search.fitting == 1 && best->fit.sigma_m <= config_.sigma_max_m)
    search.place = Loop{best->former, best->fit.fit.T_map_base, best->fit.fit.covariance, best->fit.near};
  return search;
}

}  // namespace merlin
