// A map seen from above, in which a piece of it is found without any guess of the pose. First the yaw: walls have main
// directions, and those of the piece must become those of the map (G. Weiss et al., "Keeping track of position and
// orientation of moving indoor systems by correlation of range-finder scans", IROS 1994). Then the position: the cells
// are correlated, by branch and bound over cells that are pooled in squares (E. Olson, "Real-time correlative scan
// matching", ICRA 2009; W. Hess et al., "Real-time loop closure in 2D LIDAR SLAM", ICRA 2016). Free ground of the map
// counts against a pose, so that a short piece of wall does not fit everywhere.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam/map/occupancy_grid.h"

namespace merlin {

struct PlanMatch {
  Pose T_map_base = Pose::Identity();  // to about 0.1 m and 1 deg
  // Mean over the cells of the piece: 1 where the map has a wall, 0.5 next to one, 0 where nothing is known, -0.5 where
  // it is free.
  double score = 0.0;
};

// Where to search: poses no farther than reach_m along x and y, and than reach_rad, from this one.
struct PlanRegion {
  Pose T_map_base = Pose::Identity();
  double reach_m = 0.0, reach_rad = 0.0;
};

// Only poses with about this yaw.
struct PlanHeading {
  double yaw_rad = 0.0, within_rad = 0.0;
};

class FloorPlan {
 public:
  explicit FloorPlan(const OccupancyGrid& grid);

  // Poses at which the points of the piece lie on the map's walls, best first, at most 12. No two are within 0.8 m and
  // 15 deg. heights: points outside of height_min_m and height_max_m do not count. Nothing where too few count, or no
  // pose has a score of 0.5; in a region 0.25, because at the start of a loop the map shows only a part of the piece.
  std::vector<PlanMatch> Match(std::span<const Point> points_base, const OccupancyConfig& heights,
                               const std::optional<PlanRegion>& region = {},
                               const std::optional<PlanHeading>& heading = {}) const;
  // The score of the points at this pose.
  double Score(std::span<const Point> points_base, const OccupancyConfig& heights, const Pose& T_map_base) const;
  // The map knows that there is no wall in this cell, nor in the eight around it.
  bool IsFree(const Eigen::Vector2d& point_map) const;

 private:
  static constexpr int kLevels = 5;                // the coarsest pools 16 x 16 cells
  static constexpr int kPad = 1 << (kLevels - 1);  // unknown cells around the grid: a pool may begin there
  static constexpr int kDirections = 180;          // of walls, 1 deg apart: the opposite one is the same
  using Spectrum = std::array<double, kDirections>;
  // A square of poses: (x, y) is its lowest cell, 2^level its edge.
  struct Node {
    int x = 0, y = 0, level = 0;
  };
  struct Best {
    int x = 0, y = 0, score = 0;
  };

  static Spectrum SpectrumOf(std::span<const Eigen::Vector2d> walls, double cell_m);
  std::vector<double> YawsOf(std::span<const Eigen::Vector2d> walls_base) const;
  bool Reaches(const PlanRegion& region, const Node& node) const;
  std::int8_t At(int level, int x, int y) const;
  int Bound(std::span<const Eigen::Vector2i> cells, const Node& node) const;
  void Search(std::span<const Eigen::Vector2i> cells, const Node& node, Best& best) const;
  void PoolCells();

  int width_ = 0, height_ = 0;
  double cell_m_ = 0.0;
  Eigen::Vector2d origin_m_{0, 0};
  Spectrum spectrum_{};  // of its walls
  // Of each level: the greatest value of the 2^level x 2^level cells from this one on. The values: 2 wall, 1 next to a
  // wall, 0 unknown, -1 free.
  std::array<std::vector<std::int8_t>, kLevels> levels_;
};

}  // namespace merlin
