#include "scenarios/judge/stack_outcome.h"

namespace merlin {
namespace {

std::vector<MapPoint> MapPoints(const VoxelMap& map, int points_min) {
  std::vector<MapPoint> points;
  for (const Voxel& voxel : map.voxels()) {
    if (voxel.count < points_min) continue;
    MapPoint point{.p_map = voxel.mean};
    if (voxel.has_color())
      for (int c = 0; c < 3; ++c) point.rgb[c] = static_cast<std::uint8_t>(voxel.bgr()[2 - c] + 0.5);
    points.push_back(point);
  }
  return points;
}

GridMap ToGridMap(const OccupancyGrid& grid) {
  if (grid.width() == 0) return {1, 1, grid.cell_m(), {0.0, 0.0}, {-1}};
  GridMap map{grid.width(), grid.height(), grid.cell_m(), grid.origin_m(), {}};
  for (int row = 0; row < grid.height(); ++row)
    for (int column = 0; column < grid.width(); ++column)
      map.cells.push_back(static_cast<std::int8_t>(grid.At(column, row)));
  return map;
}

Trajectory ToTrajectory(const std::vector<MapPose>& poses) {
  Trajectory trajectory;
  for (const MapPose& pose : poses) trajectory.push_back({pose.stamp, pose.T_map_base});
  return trajectory;
}

}  // namespace

StackOutcome OutcomeOf(const Slam& slam, int points_min, const std::vector<double>& stack_ms) {
  const bool found = slam.search() == Slam::Search::kFound;
  const Slam::SearchEffort& effort = slam.search_effort();
  return {.estimate = ToTrajectory(slam.trajectory()),
          .online = ToTrajectory(slam.online()),
          .map = MapPoints(slam.BuildMap(), points_min),
          .grid = ToGridMap(slam.BuildOccupancy()),
          .path_m = slam.path_m(),
          .loops_closed = slam.loops(),
          .stack_ms = stack_ms,
          .map_slam = ToBytes(slam.Saved()),
          .place_found_s = found ? std::optional(effort.time_s) : std::nullopt,
          .place_found_m = found ? std::optional(effort.path_m) : std::nullopt};
}

}  // namespace merlin
