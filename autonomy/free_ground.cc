#include "autonomy/free_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace merlin {
namespace {

// A rectangle around the origin of the base frame, x ahead and y to the left.
struct Rectangle {
  double front_m, rear_m, half_width_m;
  bool Contains(const Eigen::Vector2d& p) const {
    constexpr double kRounding_m = 1e-9;
    return p.x() <= front_m + kRounding_m && p.x() >= -rear_m - kRounding_m &&
           std::abs(p.y()) <= half_width_m + kRounding_m;
  }
};

// Points on the edges of a rectangle, at most this far apart.
std::vector<Eigen::Vector2d> EdgesOf(const Rectangle& r, double apart_m) {
  std::vector<Eigen::Vector2d> points;
  const double length_m = r.front_m + r.rear_m, width_m = 2.0 * r.half_width_m;
  const int along = static_cast<int>(std::ceil(length_m / apart_m)) + 1;
  const int across = static_cast<int>(std::ceil(width_m / apart_m)) + 1;
  for (int i = 0; i <= along; ++i)
    for (const double side : {1.0, -1.0}) points.emplace_back(-r.rear_m + length_m * i / along, side * r.half_width_m);
  for (int i = 0; i <= across; ++i)
    for (const double x : {r.front_m, -r.rear_m}) points.emplace_back(x, -r.half_width_m + width_m * i / across);
  return points;
}

}  // namespace

std::optional<double> FreeGround_m(const OccupancyGrid& grid, const Footprint& footprint, const Pose& T_map_base,
                                   std::span<const Eigen::Vector2d> path_base, const BackConfig& config) {
  const Rectangle here{footprint.front_m, footprint.rear_m, footprint.half_width_m};
  const Rectangle beside{footprint.front_m, footprint.rear_m, footprint.half_width_m + OccupancyGrid::kBeside_m};
  const Rectangle swept{footprint.front_m, footprint.rear_m + config.stop_gap_m,
                        footprint.half_width_m + config.margin_m};
  // Half a cell apart, no cell can hide between two points. The edges suffice: what they enclose was below the car before,
  // or was swept by them.
  const double apart_m = 0.5 * grid.cell_m();
  const std::vector<Eigen::Vector2d> edges = EdgesOf(swept, apart_m);
  const auto is_free = [&](const Eigen::Isometry2d& T_base_then) {
    return std::ranges::all_of(edges, [&](const Eigen::Vector2d& edge) {
      const Eigen::Vector2d p = T_base_then * edge;
      if (here.Contains(p)) return true;
      const Eigen::Vector3d p_map = T_map_base * Eigen::Vector3d(p.x(), p.y(), 0.0);
      const OccupancyGrid::Cell cell = grid.At(Eigen::Vector2d(p_map.head<2>()));
      return cell == OccupancyGrid::Cell::kFree || (cell == OccupancyGrid::Cell::kUnknown && beside.Contains(p));
    });
  };
  double free_m = 0.0;
  for (std::size_t i = 0; i + 1 < path_base.size(); ++i) {
    const Eigen::Vector2d step = path_base[i + 1] - path_base[i];
    const double length_m = step.norm();
    if (length_m == 0.0) continue;
    const int parts = static_cast<int>(std::ceil(length_m / apart_m));
    for (int part = 0; part <= parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      Eigen::Isometry2d T_base_then = Eigen::Isometry2d::Identity();
      T_base_then.translation() = path_base[i] + share * step;
      T_base_then.linear() = Eigen::Rotation2Dd(std::atan2(-step.y(), -step.x())).toRotationMatrix();
      if (!is_free(T_base_then)) return free_m;
      if (part > 0) free_m += length_m / parts;
    }
  }
  return std::nullopt;
}

}  // namespace merlin
