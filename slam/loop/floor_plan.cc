#include "slam/loop/floor_plan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "slam/map/voxel_map.h"

namespace merlin {
namespace {

constexpr std::int8_t kWallCell = 2, kNextToWallCell = 1, kUnknownCell = 0, kFreeCell = -1;
constexpr std::size_t kWallsMin = 30, kWallsMax = 250;       // cells of a piece; the rest of them tells little more
constexpr std::size_t kMatchesMax = 12;                      // each takes milliseconds to verify
constexpr double kScoreMin = 0.5, kScoreMinInRegion = 0.25;  // guesses
constexpr double kShareOfBest = 0.75;  // matches with less of the best one's score are left out; guess
constexpr double kApart_m = 0.8, kApart_rad = 0.26;
constexpr double kCorrelationMin = 0.5;    // share of the best yaw's within kAround_deg: the walls of one direction...
constexpr double kCorrelationLeast = 0.1;  // ...may be much longer than those of the other; and of the best; guesses
constexpr int kAround_deg = 20;

double Radians(int degrees) { return degrees * std::numbers::pi / 180.0; }

// The middle of each cell in which a point is as high as obstacles; evenly thinned where there are many.
std::vector<Eigen::Vector2d> WallsOf(std::span<const Point> points, const OccupancyConfig& heights, double cell_m) {
  std::vector<std::pair<int, int>> cells;
  for (const Point& point : points) {
    const Eigen::Vector3f& p = point.position;
    if (!VoxelMap::InReach(p) || p.z() < heights.height_min_m || p.z() > heights.height_max_m) continue;
    cells.emplace_back(static_cast<int>(std::floor(p.x() / cell_m)), static_cast<int>(std::floor(p.y() / cell_m)));
  }
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  const std::size_t stride = cells.size() / kWallsMax + 1;
  std::vector<Eigen::Vector2d> walls;
  for (std::size_t i = 0; i < cells.size(); i += stride)
    walls.emplace_back((cells[i].first + 0.5) * cell_m, (cells[i].second + 0.5) * cell_m);
  return walls;
}

std::vector<double> YawsIn(const PlanRegion& region) {
  std::vector<double> yaws_rad;
  const int reach = static_cast<int>(std::ceil(std::min(region.reach_rad, std::numbers::pi) / Radians(1)));
  for (int turn = -reach; turn <= reach; ++turn) yaws_rad.push_back(WrapPi(Yaw(region.T_map_base) + Radians(turn)));
  return yaws_rad;
}

bool Near(const PlanMatch& a, const PlanMatch& b) {
  const Pose apart = a.T_map_base.inverse() * b.T_map_base;
  return apart.translation().norm() < kApart_m && std::abs(Yaw(apart)) < kApart_rad;
}

}  // namespace

FloorPlan::FloorPlan(const OccupancyGrid& grid)
    : width_(grid.width() + 2 * kPad),
      height_(grid.height() + 2 * kPad),
      cell_m_(grid.cell_m()),
      origin_m_(grid.origin_m() - Eigen::Vector2d::Constant(kPad * grid.cell_m())) {
  using Cell = OccupancyGrid::Cell;
  std::vector<Eigen::Vector2d> walls;
  const auto next_to_wall = [&](int x, int y) {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (grid.At(x + dx, y + dy) == Cell::kOccupied) return true;
    return false;
  };
  for (int y = -kPad; y < height_ - kPad; ++y)
    for (int x = -kPad; x < width_ - kPad; ++x) {
      const Cell cell = grid.At(x, y);
      if (cell == Cell::kOccupied) walls.emplace_back(x * cell_m_, y * cell_m_);
      levels_[0].push_back(cell == Cell::kOccupied ? kWallCell
                           : next_to_wall(x, y)    ? kNextToWallCell
                           : cell == Cell::kFree   ? kFreeCell
                                                   : kUnknownCell);
    }
  spectrum_ = SpectrumOf(walls, cell_m_);
  PoolCells();
}

void FloorPlan::PoolCells() {
  for (int level = 1; level < kLevels; ++level) {
    const int below = level - 1, half = 1 << below;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        levels_[level].push_back(
            std::max({At(below, x, y), At(below, x + half, y), At(below, x, y + half), At(below, x + half, y + half)}));
  }
}

std::int8_t FloorPlan::At(int level, int x, int y) const {
  if (x < 0 || x >= width_ || y < 0 || y >= height_) return kUnknownCell;
  return levels_[level][static_cast<std::size_t>(y) * width_ + x];
}

bool FloorPlan::IsFree(const Eigen::Vector2d& point_map) const {
  const Eigen::Vector2i cell = ((point_map - origin_m_) / cell_m_).array().floor().cast<int>();
  return At(0, cell.x(), cell.y()) == kFreeCell;
}

// How sharply the walls stand out, seen along each direction: the sum of squares of the histogram of their distances
// from a line along it, above that of the direction where they stand out least.
FloorPlan::Spectrum FloorPlan::SpectrumOf(std::span<const Eigen::Vector2d> walls, double cell_m) {
  Spectrum spectrum{};
  if (walls.empty()) return spectrum;
  double reach_m = 0.0;
  for (const Eigen::Vector2d& wall : walls) reach_m = std::max(reach_m, wall.norm());
  const int middle = static_cast<int>(reach_m / cell_m) + 1;
  std::vector<double> histogram(static_cast<std::size_t>(2 * middle) + 1);
  for (int degrees = 0; degrees < kDirections; ++degrees) {
    std::ranges::fill(histogram, 0.0);
    const Eigen::Vector2d across(-std::sin(Radians(degrees)), std::cos(Radians(degrees)));
    for (const Eigen::Vector2d& wall : walls)
      ++histogram[static_cast<std::size_t>(middle + std::floor(across.dot(wall) / cell_m))];
    for (const double count : histogram) spectrum[degrees] += count * count;
  }
  const double least = std::ranges::min(spectrum);
  for (double& value : spectrum) value -= least;
  return spectrum;
}

// The turns of the piece that give its walls directions of the map's walls. Both ways round: walls do not tell.
std::vector<double> FloorPlan::YawsOf(std::span<const Eigen::Vector2d> walls_base) const {
  const Spectrum piece = SpectrumOf(walls_base, cell_m_);
  Spectrum correlation{};
  for (int turn = 0; turn < kDirections; ++turn)
    for (int i = 0; i < kDirections; ++i) correlation[turn] += piece[i] * spectrum_[(i + turn) % kDirections];
  const double least = kCorrelationLeast * std::ranges::max(correlation);
  const auto best_around = [&](int turn) {
    double best = 0.0;
    for (int i = -kAround_deg; i <= kAround_deg; ++i)
      best = std::max(best, correlation[(turn + i + kDirections) % kDirections]);
    return best;
  };
  std::vector<double> yaws_rad;
  for (int turn = 0; turn < kDirections; ++turn)
    if (correlation[turn] >= std::max(least, kCorrelationMin * best_around(turn)))
      yaws_rad.insert(yaws_rad.end(), {Radians(turn), WrapPi(Radians(turn) + std::numbers::pi)});
  return yaws_rad;
}

int FloorPlan::Bound(std::span<const Eigen::Vector2i> cells, const Node& node) const {
  int score = 0;
  for (const Eigen::Vector2i& cell : cells) score += At(node.level, node.x + cell.x(), node.y + cell.y());
  return score;
}

// The best pose of the node, if it is better than `best`; the child with the highest bound first.
void FloorPlan::Search(std::span<const Eigen::Vector2i> cells, const Node& node, Best& best) const {
  const int bound = Bound(cells, node);
  if (bound <= best.score) return;
  if (node.level == 0) {
    best = {node.x, node.y, bound};
    return;
  }
  const int level = node.level - 1, half = 1 << level;
  std::array<std::pair<int, Node>, 4> children;
  for (int i = 0; i < 4; ++i) {
    const Node child{node.x + (i % 2) * half, node.y + (i / 2) * half, level};
    children[i] = {Bound(cells, child), child};
  }
  std::ranges::stable_sort(children, std::greater<>{}, [](const auto& child) { return child.first; });
  for (const auto& [child_bound, child] : children)
    if (child_bound > best.score) Search(cells, child, best);
}

// Some pose of the node lies in the region.
bool FloorPlan::Reaches(const PlanRegion& region, const Node& node) const {
  const Eigen::Vector2d lowest = origin_m_ + cell_m_ * Eigen::Vector2d(node.x, node.y);
  const Eigen::Vector2d centre = region.T_map_base.translation().head<2>();
  const Eigen::Vector2d nearest =
      centre.cwiseMax(lowest).cwiseMin(lowest + Eigen::Vector2d::Constant(cell_m_ * (1 << node.level)));
  return (nearest - centre).cwiseAbs().maxCoeff() <= region.reach_m;
}

double FloorPlan::Score(std::span<const Point> points_base, const OccupancyConfig& heights,
                        const Pose& T_map_base) const {
  const std::vector<Eigen::Vector2d> walls = WallsOf(points_base, heights, cell_m_);
  double sum = 0.0;
  for (const Eigen::Vector2d& wall : walls) {
    const Eigen::Vector2d p_map = (T_map_base * Eigen::Vector3d(wall.x(), wall.y(), 0.0)).head<2>();
    const Eigen::Vector2i cell = ((p_map - origin_m_) / cell_m_).array().floor().cast<int>();
    sum += At(0, cell.x(), cell.y());
  }
  return walls.empty() ? 0.0 : sum / static_cast<double>(kWallCell * walls.size());
}

std::vector<PlanMatch> FloorPlan::Match(std::span<const Point> points_base, const OccupancyConfig& heights,
                                        const std::optional<PlanRegion>& region,
                                        const std::optional<PlanHeading>& heading) const {
  const std::vector<Eigen::Vector2d> walls = WallsOf(points_base, heights, cell_m_);
  if (walls.size() < kWallsMin) return {};
  std::vector<PlanMatch> matches;
  const double whole = static_cast<double>(kWallCell * walls.size());
  double least = region ? kScoreMinInRegion : kScoreMin;
  for (const double yaw_rad : region ? YawsIn(*region) : YawsOf(walls)) {
    if (heading && std::abs(WrapPi(yaw_rad - heading->yaw_rad)) > heading->within_rad) continue;
    std::vector<Eigen::Vector2i> cells;
    for (const Eigen::Vector2d& wall : walls)
      cells.push_back(((Eigen::Rotation2Dd(yaw_rad) * wall / cell_m_).array() + 0.5).floor().cast<int>());
    for (int y = 0; y < height_; y += kPad)
      for (int x = 0; x < width_; x += kPad) {
        const Node node{x, y, kLevels - 1};
        if (region && !Reaches(*region, node)) continue;
        Best best{.score = static_cast<int>(least * whole)};
        Search(cells, node, best);
        const double score = best.score / whole;
        if (score <= least) continue;
        const Eigen::Vector2d p = origin_m_ + cell_m_ * Eigen::Vector2d(best.x + 0.5, best.y + 0.5);
        matches.push_back({FromXyYaw(p.x(), p.y(), yaw_rad), score});
        least = std::max(least, kShareOfBest * score);
      }
  }
  std::ranges::stable_sort(matches, std::greater<>{}, &PlanMatch::score);
  std::vector<PlanMatch> apart;
  for (const PlanMatch& match : matches) {
    if (match.score < least || apart.size() == kMatchesMax) break;
    if (std::ranges::none_of(apart, [&](const PlanMatch& other) { return Near(match, other); })) apart.push_back(match);
  }
  return apart;
}

}  // namespace merlin
