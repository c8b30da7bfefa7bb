#include "autonomy/behaviors/corridor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace merlin {
namespace {

constexpr double kBin_m = 0.05;

struct WallPoint {  // axis frame
  Eigen::Vector2d p, n;
};

std::vector<WallPoint> WallPoints(const VoxelMap& map, const Pose& T_map_axis, const CorridorConfig& config) {
  const Pose T_axis_map = T_map_axis.inverse();
  std::vector<WallPoint> points;
  for (const Voxel& voxel : map.voxels()) {
    if (!voxel.has_normal() || std::abs(voxel.normal.z()) > 0.3f) continue;
    if (voxel.mean.z() < config.height_min_m || voxel.mean.z() > config.height_max_m) continue;
    const Eigen::Vector3d p = T_axis_map * voxel.mean.cast<double>();
    if (p.x() < -config.look_behind_m || p.x() > 2.0 * config.look_ahead_m || std::abs(p.y()) > 2.0 * config.side_max_m)
      continue;
    const Eigen::Vector3d n = T_axis_map.linear() * voxel.normal.cast<double>();
    points.push_back({p.head<2>(), n.head<2>().normalized()});
  }
  return points;
}

// The direction of the walls, of the four possible ones the nearest to the hint: the mean of exp(4 i angle) is the same
// for all four.
double AxisYaw(const std::vector<WallPoint>& points, double hint_rad) {
  std::complex<double> sum = 0.0;
  for (const WallPoint& point : points) sum += std::pow(std::complex<double>(point.n.x(), point.n.y()), 4);
  if (std::abs(sum) < 10.0) return hint_rad;
  return WrapPi(hint_rad + std::arg(sum) / 4.0);  // normals are in the hint's frame: arg / 4 is within 45 deg of it
}

// Distance of the wall on one side (+1 left, -1 right). Surfaces that face the car are counted in bins of their distance;
// the wall is the farthest bin that is at least half as full as the fullest, since pillars, cabinets and radiators stand
// before a wall.
std::optional<double> SideWall(const std::vector<WallPoint>& points, double side, const CorridorConfig& config) {
  std::vector<int> bins(static_cast<std::size_t>(config.side_max_m / kBin_m) + 2, 0);
  for (const WallPoint& point : points) {
    const double y = side * point.p.y();
    if (std::abs(point.n.y()) < 0.9 || y < 0.2 || y >= config.side_max_m || point.p.x() > config.look_ahead_m) continue;
    ++bins[static_cast<std::size_t>(y / kBin_m)];
  }
  int most = 0;
  for (std::size_t i = 0; i + 1 < bins.size(); ++i) most = std::max(most, bins[i] + bins[i + 1]);
  if (most < config.wall_voxels_min) return std::nullopt;
  std::size_t best = bins.size() - 2;
  while (2 * (bins[best] + bins[best + 1]) < most) --best;
  if (best > 0 && bins[best - 1] > bins[best + 1]) --best;  // the fuller of the two pairs that share its bin
  double sum = 0.0;
  int count = 0;
  for (const WallPoint& point : points) {
    const double y = side * point.p.y();
    if (std::abs(point.n.y()) < 0.9 || point.p.x() > config.look_ahead_m) continue;
    if (y >= best * kBin_m && y < (best + 2) * kBin_m) sum += y, ++count;
  }
  return side * sum / count;
}

// The nearest x at which surfaces that face the car cover the middle from side to side.
std::optional<double> EndWall(const std::vector<WallPoint>& points, double middle_m, const CorridorConfig& config) {
  const int columns = std::max(1, static_cast<int>(std::lround(2.0 * config.front_half_width_m / 0.1)));
  std::vector<double> facing_x;
  std::vector<int> facing_column;
  for (const WallPoint& point : points) {
    const double offset_m = point.p.y() - middle_m + config.front_half_width_m;
    if (std::abs(point.n.x()) < 0.85 || point.p.x() < 0.2 || offset_m < 0.0) continue;
    const int column = static_cast<int>(offset_m / 0.1);
    if (column < columns) facing_x.push_back(point.p.x()), facing_column.push_back(column);
  }
  std::vector<double> starts = facing_x;
  std::ranges::sort(starts);
  for (const double x : starts) {
    std::vector<int> hits(columns, 0);
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < facing_x.size(); ++i)
      if (facing_x[i] >= x && facing_x[i] < x + 0.15) ++hits[facing_column[i]], sum += facing_x[i], ++count;
    if (std::ranges::count_if(hits, [](int n) { return n >= 2; }) >= columns * 3 / 4) return sum / count;
  }
  return std::nullopt;
}

// Whether a passage leads off to one side just before the end wall: free cells beyond the line of the wall, and nothing
// occupied in between.
bool SideOpen(const OccupancyGrid& grid, const Pose& T_map_axis, const Corridor& corridor, double side,
              const CorridorConfig& config) {
  const double half_m = 0.5 * corridor.width_m.value_or(2.0 * config.side_distance_m);
  int open = 0, probes = 0;
  for (double x = *corridor.front_m - 1.3 * half_m; x <= *corridor.front_m - 0.5 * half_m; x += 0.2 * half_m) {
    ++probes;
    int free = 0, cells = 0;
    bool blocked = false;
    for (double y = 0.5 * half_m; y <= half_m + config.opening_m; y += grid.cell_m()) {
      const Eigen::Vector3d p_map = T_map_axis * Eigen::Vector3d(x, corridor.middle_m + side * y, 0.0);
      const OccupancyGrid::Cell cell = grid.At(Eigen::Vector2d(p_map.head<2>()));
      ++cells;
      free += cell == OccupancyGrid::Cell::kFree;
      blocked |= cell == OccupancyGrid::Cell::kOccupied;
    }
    open += !blocked && 2 * free > cells;
  }
  return 2 * open > probes;
}

}  // namespace

Corridor SeeCorridor(const VoxelMap& map, const OccupancyGrid& grid, const Pose& T_map_base, const CorridorHint& hint,
                     const CorridorConfig& config) {
  Corridor corridor;
  corridor.yaw_rad = hint.yaw_rad;
  corridor.yaw_rad = AxisYaw(WallPoints(map, corridor.T_map_axis(T_map_base), config), hint.yaw_rad);
  const Pose T_map_axis = corridor.T_map_axis(T_map_base);
  const std::vector<WallPoint> points = WallPoints(map, T_map_axis, config);

  corridor.left_m = SideWall(points, 1.0, config);
  corridor.right_m = SideWall(points, -1.0, config);
  corridor.width_m = hint.width_m;
  if (corridor.left_m && corridor.right_m) {
    corridor.width_m = *corridor.left_m - *corridor.right_m;
    corridor.middle_m = 0.5 * (*corridor.left_m + *corridor.right_m);
  } else {
    const double half_m = 0.5 * hint.width_m.value_or(2.0 * config.side_distance_m);
    if (corridor.left_m) corridor.middle_m = *corridor.left_m - half_m;
    if (corridor.right_m) corridor.middle_m = *corridor.right_m + half_m;
  }
  corridor.front_m = EndWall(points, corridor.middle_m, config);
  if (corridor.front_m) {
    corridor.left_open = SideOpen(grid, T_map_axis, corridor, 1.0, config);
    corridor.right_open = SideOpen(grid, T_map_axis, corridor, -1.0, config);
  }
  return corridor;
}

}  // namespace merlin
