// Walls for the autonomy tests, and what the stack would know of them.
#pragma once

#include <cmath>
#include <vector>

#include "slam/map/occupancy_grid.h"
#include "slam/map/voxel_map.h"

namespace merlin {

// Walls as exact points every 4 cm, 0.1 to 1.3 m high, turned as a whole by an angle.
class Walls {
 public:
  explicit Walls(double yaw_rad) : T_map_plan_(FromXyYaw(0.0, 0.0, yaw_rad)) {}
  void Add(double x0, double y0, double x1, double y1) {
    const double length_m = std::hypot(x1 - x0, y1 - y0);
    for (double s = 0.0; s <= length_m; s += 0.04)
      for (double z = 0.1; z < 1.3; z += 0.04)
        points_.push_back({.position = {static_cast<float>(x0 + (x1 - x0) * s / length_m),
                                        static_cast<float>(y0 + (y1 - y0) * s / length_m), static_cast<float>(z)},
                           .sigma_m = 0.01f});
  }
  VoxelMap Map() const {
    VoxelMap map({});
    map.Insert(points_, T_map_plan_, 0.0);
    return map;
  }
  // The grid as a camera at the plan's origin with a free view in all directions would have carved it.
  OccupancyGrid Grid() const {
    OccupancyGrid grid({});
    std::vector<Point> points;
    for (const Point& point : points_)
      if (std::abs(point.position.z() - 0.7f) < 0.05f) points.push_back(point);
    for (int i = 0; i < 2; ++i) grid.Insert(points, {0.0f, 0.0f, 0.7f}, T_map_plan_);
    return grid;
  }
  const Pose& T_map_plan() const { return T_map_plan_; }
  const std::vector<Point>& points_plan() const { return points_; }

 private:
  Pose T_map_plan_;
  std::vector<Point> points_;
};

// A corridor 2 m wide, the plan's origin 0.2 m left of its middle; its end 4 m ahead, open to the left.
inline Walls EndOpenToTheLeft(double yaw_rad) {
  Walls walls(yaw_rad);
  walls.Add(-2.0, 0.8, 2.0, 0.8);
  walls.Add(-2.0, -1.2, 4.0, -1.2);
  walls.Add(4.0, -1.2, 4.0, 2.5);
  return walls;
}

// The same, 2 m wide and with the origin in its middle, but closed on all sides.
inline Walls DeadEnd(double yaw_rad) {
  Walls walls(yaw_rad);
  walls.Add(-2.0, 1.0, 4.0, 1.0);
  walls.Add(-2.0, -1.0, 4.0, -1.0);
  walls.Add(4.0, -1.0, 4.0, 1.0);
  return walls;
}

}  // namespace merlin
