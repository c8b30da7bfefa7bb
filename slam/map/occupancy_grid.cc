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
  const auto cell_of = [this](const Eigen::Vector3d& p) {
    return Eigen::Vector2i((p.head<2>() / config_.cell_m).array().floor().cast<int>());
  };
  const Eigen::Vector3d camera_map = T_map_base * camera_base.cast<double>();
  const Eigen::Vector2i from = cell_of(camera_map);
  GrowTo(from.x(), from.y());
  const double steepest = std::tan(config_.sweep_rad);
  for (const Point& point : points_base) {
    const Eigen::Vector3d p_map = T_map_base * point.position.cast<double>();
    if (!((p_map - camera_map).norm() < kFarthest_m)) continue;  // not finite either
    const Eigen::Vector3d ray = p_map - camera_map;
    const Eigen::Vector2i to = cell_of(p_map);
    GrowTo(to.x(), to.y());
    if (std::abs(ray.z()) <= steepest * ray.head<2>().norm()) FreeAlong(from.x(), from.y(), to.x(), to.y());
    if (p_map.z() >= config_.height_min_m && p_map.z() <= config_.height_max_m) Add(to.x(), to.y(), kHit);
  }
}

OccupancyGrid::Cell OccupancyGrid::At(int column, int row) const {
  if (column < 0 || column >= width_ || row < 0 || row >= height_) return Cell::kUnknown;
  const int value = log_odds_[static_cast<std::size_t>(row) * width_ + column];
  return value == 0 ? Cell::kUnknown : value > 0 ? Cell::kOccupied : Cell::kFree;
}

OccupancyGrid::Cell OccupancyGrid::At(const Eigen::Vector2d& point_map) const {
  const Eigen::Vector2i cell = (point_map / config_.cell_m).array().floor().cast<int>();
  return At(cell.x() - x0_, cell.y() - y0_);
}

}  // namespace merlin
