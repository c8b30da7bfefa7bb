#include "slam/map/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace merlin {
namespace {

// A hit weighs as much as four rays that pass. At most ten hits are remembered, so that what has gone is soon
// forgotten.
constexpr int kHit = 4;
constexpr int kPass = -1;
constexpr int kLimit = 40;
constexpr double kFarthest_m = 100.0;  // longer ranges are wrong, and would make the grid huge

}  // namespace

Eigen::Vector2i OccupancyGrid::CellOf(const Eigen::Vector2d& point_map) const {
  return (point_map / config_.cell_m).array().floor().cast<int>();
}

void OccupancyGrid::GrowTo(int x, int y) {
  if (width_ > 0 && x >= x0_ && x < x0_ + width_ && y >= y0_ && y < y0_ + height_) return;
  const int margin = std::max(64, std::max(width_, height_) / 2);
  const int old_width = width_, old_height = height_, old_x0 = x0_, old_y0 = y0_;
  const int left = width_ == 0 ? x - margin : (x < x0_ ? x - margin : x0_);
  const int low = width_ == 0 ? y - margin : (y < y0_ ? y - margin : y0_);
  const int right = width_ == 0 ? x + margin : (x >= x0_ + width_ ? x + margin : x0_ + width_);
  const int high = width_ == 0 ? y + margin : (y >= y0_ + height_ ? y + margin : y0_ + height_);
  std::vector<std::int8_t> old = std::move(log_odds_);
  x0_ = left, y0_ = low, width_ = right - left, height_ = high - low;
  log_odds_.assign(static_cast<std::size_t>(width_) * height_, 0);
  for (int row = 0; row < old_height; ++row)
    std::copy_n(old.begin() + static_cast<std::ptrdiff_t>(row) * old_width, old_width,
                log_odds_.begin() + static_cast<std::ptrdiff_t>(row + old_y0 - y0_) * width_ + (old_x0 - x0_));
}

void OccupancyGrid::Add(int x, int y, int log_odds) {
  std::int8_t& cell = log_odds_[static_cast<std::size_t>(y - y0_) * width_ + (x - x0_)];
  cell = static_cast<std::int8_t>(std::clamp(cell + log_odds, -kLimit, kLimit));
}

void OccupancyGrid::FreeAlong(int x0, int y0, int x1, int y1) {  // Bresenham, the last cell left out
  const int dx = std::abs(x1 - x0), dy = -std::abs(y1 - y0);
  const int sx = x0 < x1 ? 1 : -1, sy = y0 < y1 ? 1 : -1;
  int error = dx + dy;
  while (x0 != x1 || y0 != y1) {
    Add(x0, y0, kPass);
    const int twice = 2 * error;
    if (twice >= dy) error += dy, x0 += sx;
    if (twice <= dx) error += dx, y0 += sy;
  }
}

void OccupancyGrid::Insert(std::span<const Point> points_base, const Eigen::Vector3f& camera_base,
                           const Pose& T_map_base) {
  const Eigen::Vector3d camera_map = T_map_base * camera_base.cast<double>();
  const Eigen::Vector2i from = CellOf(camera_map.head<2>());
  GrowTo(from.x(), from.y());
  const double steepest = std::tan(config_.sweep_rad);
  for (const Point& point : points_base) {
    const Eigen::Vector3d p_map = T_map_base * point.position.cast<double>();
    if (!((p_map - camera_map).norm() < kFarthest_m)) continue;  // not finite either
    const Eigen::Vector3d ray = p_map - camera_map;
    const Eigen::Vector2i to = CellOf(p_map.head<2>());
    GrowTo(to.x(), to.y());
    if (std::abs(ray.z()) <= steepest * ray.head<2>().norm()) FreeAlong(from.x(), from.y(), to.x(), to.y());
    if (p_map.z() >= config_.height_min_m && p_map.z() <= config_.height_max_m) Add(to.x(), to.y(), kHit);
  }
}

void OccupancyGrid::Cover(const Footprint& footprint, const Pose& T_map_base) {
  if (!(footprint.front_m + footprint.rear_m > 0.0 && footprint.half_width_m > 0.0)) return;
  const double half_width_m = footprint.half_width_m + kBeside_m;
  const double reach_m = std::hypot(std::max(footprint.front_m, footprint.rear_m), half_width_m);
  const Eigen::Vector2d middle = T_map_base.translation().head<2>();
  const Eigen::Vector2i low = CellOf(middle.array() - reach_m), high = CellOf(middle.array() + reach_m);
  GrowTo(low.x(), low.y());
  GrowTo(high.x(), high.y());
  const Pose T_base_map = T_map_base.inverse();
  for (int y = low.y(); y <= high.y(); ++y)
    for (int x = low.x(); x <= high.x(); ++x) {
      const Eigen::Vector2d cell = (Eigen::Array2d(x, y) + 0.5) * config_.cell_m;
      const Eigen::Vector3d p_base = T_base_map * Eigen::Vector3d(cell.x(), cell.y(), T_map_base.translation().z());
      const bool below =
          p_base.x() <= footprint.front_m && p_base.x() >= -footprint.rear_m && std::abs(p_base.y()) <= half_width_m;
      if (below && At(x - x0_, y - y0_) == Cell::kUnknown) Add(x, y, kPass);
    }
}

OccupancyGrid::Cell OccupancyGrid::At(int column, int row) const {
  if (column < 0 || column >= width_ || row < 0 || row >= height_) return Cell::kUnknown;
  const int value = log_odds_[static_cast<std::size_t>(row) * width_ + column];
  return value == 0 ? Cell::kUnknown : value > 0 ? Cell::kOccupied : Cell::kFree;
}

OccupancyGrid::Cell OccupancyGrid::At(const Eigen::Vector2d& point_map) const {
  const Eigen::Vector2i cell = CellOf(point_map);
  return At(cell.x() - x0_, cell.y() - y0_);
}

}  // namespace merlin
