// Clouds of a plain room, for the judge's tests.
#pragma once

#include <cmath>
#include <vector>

#include "scenarios/judge/map_point.h"
#include "scenarios/judge/outline.h"

namespace merlin {

// Points of a vertical wall from a to b, every 5 cm along it and in height.
inline void AddWall(std::vector<MapPoint>& map, const Eigen::Vector2d& a_m, const Eigen::Vector2d& b_m,
                    double height_max_m = 2.2) {
  const double step_m = 0.05, length_m = (b_m - a_m).norm();
  for (int i = 0; (i + 0.5) * step_m < length_m; ++i) {
    const Eigen::Vector2d p = a_m + (b_m - a_m) * ((i + 0.5) * step_m / length_m);
    for (int k = 0; (k + 0.5) * step_m < height_max_m; ++k)
      map.push_back({Eigen::Vector3d(p.x(), p.y(), (k + 0.5) * step_m).cast<float>()});
  }
}

inline std::vector<MapPoint> CloudOfWalls(const Outline& outline) {
  std::vector<MapPoint> map;
  for (const OutlineWall& wall : Walls(outline)) AddWall(map, wall.a_m, wall.b_m);
  return map;
}

inline Outline Rectangle(double width_m, double height_m) {
  return {{-0.5 * width_m, -0.5 * height_m},
          {0.5 * width_m, -0.5 * height_m},
          {0.5 * width_m, 0.5 * height_m},
          {-0.5 * width_m, 0.5 * height_m}};
}

}  // namespace merlin
