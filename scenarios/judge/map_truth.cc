#include "scenarios/judge/map_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scenarios/judge/point_grid.h"

namespace merlin {
namespace {

constexpr double kSampleStep_m = 0.05;
constexpr double kSampleHeight_m = 1.0;
constexpr double kEyeHeight_m = 0.35;
constexpr double kEyeStep_m = 0.25;
constexpr double kSight_m = 7.0;  // below 7.495 m, where the range of a 20 MHz camera wraps
constexpr double kHitTolerance_m = 0.05;
constexpr double kShownReach_m = 0.10;
constexpr double kShownHeightMin_m = 0.1;
constexpr double kWallHeightMin_m = 0.3;
const double kLevelSine = std::sin(20.0 * std::numbers::pi / 180.0);
constexpr std::size_t kJudgedMax = 20000;  // limits the number of rays

std::vector<Eigen::Vector3d> Eyes(const Trajectory& truth) {
  std::vector<Eigen::Vector3d> eyes;
  double since_m = kEyeStep_m;  // the first position counts
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) since_m += (truth[i].T.translation() - truth[i - 1].T.translation()).norm();
    if (since_m < kEyeStep_m) continue;
    since_m = 0.0;
    eyes.push_back(truth[i].T.translation() + kEyeHeight_m * Eigen::Vector3d::UnitZ());
  }
  return eyes;
}

std::vector<Eigen::Vector3d> OutlineSamples(const Outline& outline) {
  std::vector<Eigen::Vector3d> samples;
  for (const OutlineWall& wall : Walls(outline)) {
    for (int i = 0; (i + 0.5) * kSampleStep_m < wall.Length_m(); ++i) {
      const Eigen::Vector2d sample = wall.a_m + (i + 0.5) * kSampleStep_m * wall.Along();
      samples.emplace_back(sample.x(), sample.y(), kSampleHeight_m);
    }
  }
  return samples;
}

bool IsVisible(const Eigen::Vector3d& sample, const std::vector<Eigen::Vector3d>& eyes, const TrueRange& true_range) {
  return std::any_of(eyes.begin(), eyes.end(), [&](const Eigen::Vector3d& eye) {
    const double distance_m = (sample - eye).norm();
    return distance_m <= kSight_m &&
           std::abs(true_range(eye, (sample - eye) / distance_m) - distance_m) <= kHitTolerance_m;
  });
}

Eigen::Vector3d FromAbove(const Eigen::Vector3d& p) { return {p.x(), p.y(), 0.0}; }

double DistanceToSurface_m(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, const TrueRange& true_range) {
  double distance_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& axis :
       {normal, Eigen::Vector3d(Eigen::Vector3d::UnitX()), Eigen::Vector3d(Eigen::Vector3d::UnitY()),
        Eigen::Vector3d(Eigen::Vector3d::UnitZ())})
    distance_m = std::min({distance_m, true_range(p, axis), true_range(p, -axis)});
  return distance_m;
}

}  // namespace

std::optional<double> CoveragePercent(std::span<const MapPoint> map, const Pose& T_world_map, const Outline& outline,
                                      const Trajectory& truth, const TrueRange& true_range) {
  std::vector<Eigen::Vector3d> points = ToWorld(map, T_world_map);
  std::erase_if(points, [](const Eigen::Vector3d& p) { return p.z() < kShownHeightMin_m || p.z() > kWallTop_m; });
  std::transform(points.begin(), points.end(), points.begin(), FromAbove);
  const PointGrid grid(std::move(points), kShownReach_m);
  const std::vector<Eigen::Vector3d> eyes = Eyes(truth);
  int visible = 0, shown = 0;
  for (const Eigen::Vector3d& sample : OutlineSamples(outline)) {
    if (!IsVisible(sample, eyes, true_range)) continue;
    ++visible;
    bool has_point = false;
    grid.VisitAround(FromAbove(sample), [&has_point](const Eigen::Vector3d&) { has_point = true; });
    if (has_point) ++shown;
  }
  if (visible == 0) return std::nullopt;
  return 100.0 * shown / visible;
}

std::optional<double> MapToPlanP95_m(std::span<const MapPoint> map, const Pose& T_world_map,
                                     const TrueRange& true_range) {
  std::vector<Eigen::Vector3d> points = ToWorld(map, T_world_map);
  std::vector<Eigen::Vector3d> candidates = points;
  std::erase_if(candidates, [](const Eigen::Vector3d& p) { return p.z() < kWallHeightMin_m || p.z() > kWallTop_m; });
  const PointGrid grid(std::move(points), kNormalRadius_m);
  const std::size_t step = (candidates.size() + kJudgedMax - 1) / kJudgedMax;
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < candidates.size(); i += step) {
    const std::optional<Eigen::Vector3d> normal = NormalAt(grid, candidates[i]);
    if (!normal || std::abs(normal->z()) > kLevelSine) continue;
    distances_m.push_back(DistanceToSurface_m(candidates[i], *normal, true_range));
  }
  if (distances_m.empty()) return std::nullopt;
  const std::size_t rank = (distances_m.size() * 95 + 99) / 100;  // ceil(0.95 n)
  std::nth_element(distances_m.begin(), distances_m.begin() + static_cast<std::ptrdiff_t>(rank) - 1, distances_m.end());
  const double p95_m = distances_m[rank - 1];
  return std::isfinite(p95_m) ? std::optional(p95_m) : std::nullopt;
}

}  // namespace merlin
