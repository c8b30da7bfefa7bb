// Free and occupied ground, seen from above: a grid of log odds (H. Moravec and A. Elfes, "High resolution maps from
// wide angle sonar", ICRA 1985). The cells along a ray become freer, the cell at its end more occupied where the point
// is as high as an obstacle. What no ray met is free where the car itself has been. The grid grows as needed. Map frame.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "perception/observation.h"
#include "robot/base/config.h"
#include "robot/types/footprint.h"
#include "robot/types/se3.h"

namespace merlin {

struct OccupancyConfig {
  double cell_m = 0.05;        // [0.01, 1] edge
  double height_min_m = 0.08;  // [-1, 3] lower points are floor
  double height_max_m = 1.2;   // [0, 10] higher points are above the car
  double sweep_rad = 0.1;      // [0, 1.5] rays at a larger angle to the floor free no cells: they pass above obstacles
};

template <class Visitor>
void Visit(Visitor& v, OccupancyConfig& c) {
  v("cell_m", c.cell_m, {0.01, 1.0});
  v("height_min_m", c.height_min_m, {-1.0, 3.0});
  v("height_max_m", c.height_max_m, {0.0, 10.0});
  v("sweep_rad", c.sweep_rad, {0.0, 1.5});
}

class OccupancyGrid {
 public:
  enum class Cell : std::int8_t { kUnknown = -1, kFree = 0, kOccupied = 100 };  // values of ROS nav_msgs/OccupancyGrid

  explicit OccupancyGrid(const OccupancyConfig& config) : config_(config) {}
  // camera_base: where the rays of the points begin.
  void Insert(std::span<const Point> points_base, const Eigen::Vector3f& camera_base, const Pose& T_map_base);
  // The car stands here: unknown cells become free whose middle is below it, or up to kBeside_m beside it, since key
  // frames are apart and poses err. Known cells stay as they are, and what is seen later counts as anywhere. An empty
  // footprint covers nothing.
  static constexpr double kBeside_m = 0.1;
  void Cover(const Footprint& footprint, const Pose& T_map_base);

  Cell At(const Eigen::Vector2d& point_map) const;  // unknown outside
  int width() const { return width_; }
  int height() const { return height_; }
  Eigen::Vector2d origin_m() const { return {x0_ * config_.cell_m, y0_ * config_.cell_m}; }  // corner of cell (0, 0)
  double cell_m() const { return config_.cell_m; }
  Cell At(int column, int row) const;  // row 0 at the lowest y

 private:
  Eigen::Vector2i CellOf(const Eigen::Vector2d& point_map) const;
  void GrowTo(int x, int y);
  void Add(int x, int y, int log_odds);
  void FreeAlong(int x0, int y0, int x1, int y1);

  OccupancyConfig config_;
  int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;  // cells
  std::vector<std::int8_t> log_odds_;             // row by row; 0: unknown; clamped to +-kLimit
};

}  // namespace merlin
