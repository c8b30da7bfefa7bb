#include "scenarios/judge/point_grid.h"

#include <Eigen/Eigenvalues>
#include <tuple>
#include <utility>

namespace merlin {
namespace {

constexpr double kFarthest_m = 1e6;
constexpr int kNeighboursMin = 5;
constexpr double kLineShare = 0.01;  // a second variance below this share of the first: the points lie on a line

}  // namespace

std::vector<Eigen::Vector3d> ToWorld(std::span<const MapPoint> map, const Pose& T_world_map) {
  std::vector<Eigen::Vector3d> points_world;
  points_world.reserve(map.size());
  for (const MapPoint& point : map) {
    const Eigen::Vector3d p_world = T_world_map * point.p_map.cast<double>();
    if ((p_world.array().abs() < kFarthest_m).all()) points_world.push_back(p_world);  // false for NaN
  }
  return points_world;
}

PointGrid::PointGrid(std::vector<Eigen::Vector3d> points, double radius_m)
    : radius_m_(radius_m), points_(std::move(points)) {
  std::sort(points_.begin(), points_.end(), [this](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::tuple(Cell(a.x()), Cell(a.y()), a.z(), a.x(), a.y()) <
           std::tuple(Cell(b.x()), Cell(b.y()), b.z(), b.x(), b.y());
  });
  for (std::ptrdiff_t i = 0; i < std::ssize(points_); ++i) {
    const auto [column, added] = columns_.try_emplace(Key(Cell(points_[i].x()), Cell(points_[i].y())), Column{i, i});
    column->second.end = i + 1;
  }
}

std::optional<Eigen::Vector3d> NormalAt(const PointGrid& grid, const Eigen::Vector3d& p) {
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  grid.VisitAround(p, [&](const Eigen::Vector3d& q) {
    const Eigen::Vector3d d = q - p;
    sum += d;
    squares += d * d.transpose();
    ++count;
  });
  if (count < kNeighboursMin) return std::nullopt;
  const Eigen::Matrix3d covariance = squares / count - (sum / count) * (sum / count).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(covariance);
  if (spread.eigenvalues()(1) <= kLineShare * spread.eigenvalues()(2)) return std::nullopt;
  return spread.eigenvectors().col(0);
}

}  // namespace merlin
