// A car of pure kinematics for the autonomy tests, and ground that its map knows.
#pragma once

#include <cmath>

#include "robot/types/car.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"
#include "slam/map/occupancy_grid.h"

namespace merlin {

// Follows commands at once: x' = v cos(yaw), y' = v sin(yaw), yaw' = v tan(steering) / wheelbase.
struct ToyCar {
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
  double wheelbase_m = 0.33;

  Pose T_map_base() const { return FromXyYaw(x_m, y_m, yaw_rad); }
  void Drive(const DriveCommand& command, double seconds) {
    constexpr int kParts = 10;
    for (int i = 0; i < kParts; ++i) {
      const double step_m = command.speed_m_s * seconds / kParts;
      x_m += step_m * std::cos(yaw_rad), y_m += step_m * std::sin(yaw_rad);
      yaw_rad = WrapPi(yaw_rad + step_m * std::tan(command.steering_rad) / wheelbase_m);
    }
  }
};

// Marks all cells of a rectangle as seen to be free: rows of rays that pass over everything.
inline void SeeFree(OccupancyGrid& grid, double x0, double x1, double y0, double y1) {
  constexpr float kAbove_m = 1.5f;
  for (double y = y0 + 0.5 * grid.cell_m(); y < y1; y += grid.cell_m()) {
    const Point end{.position = Eigen::Vector3d(x0 - 0.5 * grid.cell_m(), y, kAbove_m).cast<float>()};
    grid.Insert(std::span(&end, 1), Eigen::Vector3d(x1 - 0.5 * grid.cell_m(), y, kAbove_m).cast<float>(),
                Pose::Identity());
  }
}

// Marks the cell at a point as occupied.
inline void SeeOccupied(OccupancyGrid& grid, double x, double y) {
  const Point hit{.position = Eigen::Vector3d(x, y, 0.5).cast<float>()};
  for (int i = 0; i < 2; ++i) grid.Insert(std::span(&hit, 1), hit.position, Pose::Identity());
}

}  // namespace merlin
