// What the maps say about the corridor the car is in: its axis, its walls, its end, and where it goes on.
//
// All lengths are in the axis frame: origin at the car, x along the axis, y to its left.
//
//        left wall   ----------------------    open side
//                                          |         |
//        middle line - - - car - - - - - - - - - - - | end wall
//                                                    |
//        right wall  --------------------------------
//
// It assumes walls that meet at right angles near the car. The axis is the mean direction of the walls' normals, taken
// modulo 90 degrees. A side wall is the farthest distance at which about as many surfaces face the car as at any other,
// since pillars and cabinets stand before a wall. The end wall covers the middle line to both sides. A side is open where
// the occupancy grid knows free ground beyond the line of the wall, just before the end wall.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "robot/base/config.h"
#include "robot/types/se3.h"
#include "slam/map/occupancy_grid.h"
#include "slam/map/voxel_map.h"

namespace merlin {

struct CorridorConfig {
  double look_behind_m = 2.0;    // [0, 20] walls are looked for from this far behind the car...
  double look_ahead_m = 5.0;     // [0.5, 20] ...to this far ahead
  double side_max_m = 2.5;       // [0.3, 10] a wall farther to the side does not belong to this corridor
  double height_min_m = 0.12;    // [0, 3] of wall points
  double height_max_m = 1.5;     // [0, 5]
  double side_distance_m = 1.0;  // [0.2, 5] kept from the only wall that is seen, until a width is known
  int wall_voxels_min = 80;      // [1, 1e5] a wall has at least so many: most of a metre of it. Fewer may be a pillar
  double front_half_width_m = 0.6;  // [0.1, 5] an end wall covers this much to both sides of the middle
  double opening_m = 0.35;          // [0.05, 5] a side is open if it is free this far beyond the wall's line
};

template <class Visitor>
void Visit(Visitor& v, CorridorConfig& c) {
  v("look_behind_m", c.look_behind_m, {0.0, 20.0});
  v("look_ahead_m", c.look_ahead_m, {0.5, 20.0});
  v("side_max_m", c.side_max_m, {0.3, 10.0});
  v("height_min_m", c.height_min_m, {0.0, 3.0});
  v("height_max_m", c.height_max_m, {0.0, 5.0});
  v("side_distance_m", c.side_distance_m, {0.2, 5.0});
  v("wall_voxels_min", c.wall_voxels_min, {1.0, 1e5});
  v("front_half_width_m", c.front_half_width_m, {0.1, 5.0});
  v("opening_m", c.opening_m, {0.05, 5.0});
}

// What was known of the corridor before.
struct CorridorHint {
  double yaw_rad = 0.0;           // of the axis, map frame
  std::optional<double> width_m;  // as last seen between two walls
};

struct Corridor {
  double yaw_rad = 0.0;           // of the axis, map frame
  std::optional<double> left_m;   // y of the left wall, positive
  std::optional<double> right_m;  // y of the right wall, negative
  double middle_m = 0.0;          // y of the middle line
  std::optional<double> width_m;  // seen now, or the hint's
  std::optional<double> front_m;  // x of the wall that ends it
  bool left_open = false;         // before the end wall, a passage leads off to this side; known only with front_m
  bool right_open = false;

  Pose T_map_axis(const Pose& T_map_base) const {
    return FromXyYaw(T_map_base.translation().x(), T_map_base.translation().y(), yaw_rad);
  }
};

// map, grid: near the car, in the map frame. hint: decides which of the four directions of the walls is the axis, and
// stands in for what is not seen.
Corridor SeeCorridor(const VoxelMap& map, const OccupancyGrid& grid, const Pose& T_map_base, const CorridorHint& hint,
                     const CorridorConfig& config);

}  // namespace merlin
