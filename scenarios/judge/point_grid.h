// A point cloud in a hashed grid, for searches within a radius.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "robot/types/se3.h"
#include "scenarios/judge/map_point.h"

namespace merlin {

constexpr double kWallTop_m = 2.0;        // higher points do not count as wall
constexpr double kNormalRadius_m = 0.15;  // the normal of a point comes from its neighbours within this radius

// The map's points in the world frame, without those that are not finite or beyond 1e6 m.
std::vector<Eigen::Vector3d> ToWorld(std::span<const MapPoint> map, const Pose& T_world_map);

// Columns of cells over x and y, each sorted by height. Points are visited in an order that depends on the cloud only.
class PointGrid {
 public:
  // radius_m: the radius of all searches. points: finite and within 1e6 m.
  PointGrid(std::vector<Eigen::Vector3d> points, double radius_m);

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  double radius_m() const { return radius_m_; }

  // Calls visit(point) for every point within the radius of p, p itself included if it is one.
  template <class Visit>
  void VisitAround(const Eigen::Vector3d& p, Visit visit) const {
    const std::int64_t cell_x = Cell(p.x()), cell_y = Cell(p.y());
    for (std::int64_t x = cell_x - 1; x <= cell_x + 1; ++x) {
      for (std::int64_t y = cell_y - 1; y <= cell_y + 1; ++y) {
        const auto column = columns_.find(Key(x, y));
        if (column == columns_.end()) continue;
        const auto end = points_.begin() + column->second.end;
        auto point = std::partition_point(points_.begin() + column->second.begin, end,
                                          [&](const Eigen::Vector3d& q) { return q.z() < p.z() - radius_m_; });
        for (; point != end && point->z() <= p.z() + radius_m_; ++point)
          if ((*point - p).squaredNorm() <= radius_m_ * radius_m_) visit(*point);
      }
    }
  }

 private:
  struct Column {
    std::ptrdiff_t begin = 0;
    std::ptrdiff_t end = 0;
  };
  std::int64_t Cell(double coordinate_m) const {
    return static_cast<std::int64_t>(std::floor(coordinate_m / radius_m_));
  }
  static std::uint64_t Key(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x) << 32) ^ (static_cast<std::uint64_t>(y) & 0xffffffffu);
  }

  double radius_m_;
  std::vector<Eigen::Vector3d> points_;
  std::unordered_map<std::uint64_t, Column> columns_;
};

// Unit normal of the cloud at p, with either sign: the direction in which the points within the grid's radius spread
// least. None if there are fewer than five points or they lie on a line.
std::optional<Eigen::Vector3d> NormalAt(const PointGrid& grid, const Eigen::Vector3d& p);

}  // namespace merlin
