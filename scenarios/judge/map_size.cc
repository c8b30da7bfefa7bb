#include "scenarios/judge/map_size.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenarios/judge/point_grid.h"

namespace merlin {
namespace {

constexpr double kHeightMin_m = 0.3;
constexpr double kReach_m = 1.5;
const double kNormalCosine = std::cos(20.0 * std::numbers::pi / 180.0);
constexpr double kBin_m = 0.02;
constexpr int kBins = 150;  // over +-kReach_m
constexpr double kFitHalfWidth_m = 0.10;
constexpr std::size_t kPointsMin = 50;
const double kOppositeCosine = std::cos(std::numbers::pi / 180.0);

bool IsOfWall(const Eigen::Vector3d& normal, const OutlineWall& wall) {
  return std::abs(normal.head<2>().dot(wall.Normal())) >= kNormalCosine;
}

// offsets_m[k]: distances of the map points of walls[k] from the line of that wall.
std::vector<std::vector<double>> OffsetsFromWalls(const PointGrid& grid, const std::vector<OutlineWall>& walls) {
  std::vector<std::vector<double>> offsets_m(walls.size());
  for (const Eigen::Vector3d& p : grid.points()) {
    if (p.z() < kHeightMin_m || p.z() > kWallTop_m) continue;
    std::optional<Eigen::Vector3d> normal;
    for (std::size_t k = 0; k < walls.size(); ++k) {
      if (walls[k].Distance_m(p.head<2>()) > kReach_m) continue;
      if (!normal) normal = NormalAt(grid, p);
      if (!normal) break;
      if (IsOfWall(*normal, walls[k])) offsets_m[k].push_back(walls[k].Offset_m(p.head<2>()));
    }
  }
  return offsets_m;
}

double HistogramPeak_m(const std::vector<double>& offsets_m) {
  std::array<int, kBins> histogram{};
  for (const double offset_m : offsets_m)
    ++histogram[static_cast<std::size_t>(
        std::clamp(static_cast<int>(std::floor((offset_m + kReach_m) / kBin_m)), 0, kBins - 1))];
  const auto peak = std::max_element(histogram.begin(), histogram.end()) - histogram.begin();
  return (static_cast<double>(peak) + 0.5) * kBin_m - kReach_m;
}

std::optional<double> WallOffset_m(const std::vector<double>& offsets_m) {
  if (offsets_m.size() < kPointsMin) return std::nullopt;
  const double peak_m = HistogramPeak_m(offsets_m);
  double sum_m = 0.0;
  std::size_t count = 0;
  for (const double offset_m : offsets_m) {
    if (std::abs(offset_m - peak_m) > kFitHalfWidth_m) continue;
    sum_m += offset_m;
    ++count;
  }
  if (count < kPointsMin) return std::nullopt;
  return sum_m / static_cast<double>(count);
}

std::optional<std::size_t> Opposite(const std::vector<OutlineWall>& walls, std::size_t k) {
  std::optional<std::size_t> opposite;
  double farthest_m = 0.0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double distance_m = std::abs(walls[k].Offset_m(0.5 * (walls[i].a_m + walls[i].b_m)));
    if (walls[i].Along().dot(walls[k].Along()) > -kOppositeCosine || distance_m <= farthest_m) continue;
    farthest_m = distance_m;
    opposite = i;
  }
  return opposite;
}

}  // namespace

MapSize MeasureMapSize(std::span<const MapPoint> map, const Pose& T_world_map, const Outline& outline) {
  const std::vector<OutlineWall> walls = Walls(outline);
  const PointGrid grid(ToWorld(map, T_world_map), kNormalRadius_m);
  const std::vector<std::vector<double>> offsets_m = OffsetsFromWalls(grid, walls);
  MapSize size;
  for (std::size_t k = 0; k < 2 && k < walls.size(); ++k) {
    const std::optional<std::size_t> opposite = Opposite(walls, k);
    if (!opposite) continue;
    // Both normals point out of the room, or both into it, so the offset of the opposite wall has the opposite sign.
    const double plan_m = walls[k].Offset_m(0.5 * (walls[*opposite].a_m + walls[*opposite].b_m));
    size.plan_m[k] = std::abs(plan_m);
    const std::optional<double> here_m = WallOffset_m(offsets_m[k]);
    const std::optional<double> there_m = WallOffset_m(offsets_m[*opposite]);
    if (!here_m || !there_m) continue;
    size.size_m[k] = std::abs(plan_m - *there_m - *here_m);
    size.error_percent[k] = 100.0 * std::abs(*size.size_m[k] - *size.plan_m[k]) / *size.plan_m[k];
  }
  return size;
}

}  // namespace merlin
