// A sparse map of cubic voxels. Each voxel keeps the weighted moments of the points that fell into it; with its 26
// neighbours they give a surface: mean, normal, flatness. Points that are not finite, or beyond 1000 km, are left out.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "perception/observation.h"
#include "robot/types/config.h"
#include "robot/types/se3.h"

namespace merlin {

struct VoxelMapConfig {
  double voxel_m = 0.1;         // [0.005, 2] edge; larger is faster and reaches farther, smaller is sharper
  double flatness_max = 0.1;    // [0, 1] smallest over middle eigenvalue of a neighbourhood that counts as a plane; guess
  int plane_points_min = 6;     // [3, 1000] points a neighbourhood needs for a plane; guess
};

template <class Visitor>
void Visit(Visitor& v, VoxelMapConfig& c) {
  v("voxel_m", c.voxel_m, {0.005, 2.0});
  v("flatness_max", c.flatness_max, {0.0, 1.0});
  v("plane_points_min", c.plane_points_min, {3.0, 1000.0});
}

struct Voxel {
  std::array<std::int32_t, 3> cell{};
  int count = 0;                            // points that fell in
  double weight = 0.0;                      // their sum of 1 / sigma^2, 1 at 1 cm
  Eigen::Vector3d sum{0, 0, 0};             // weighted, relative to the voxel's centre
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d bgr_sum{0, 0, 0};
  int colored = 0;                          // points with colour
  double last_seen_m = 0.0;                 // path length at which a point last fell in
  Eigen::Vector3f mean{0, 0, 0};            // in the map frame
  Eigen::Vector3f normal{0, 0, 0};          // unit, either sign; zero: the neighbourhood is no plane
  bool has_normal() const { return !normal.isZero(); }
};

class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapConfig& config) : config_(config) {}

  // path_m: length driven so far, remembered as the voxels' last_seen_m.
  void Insert(std::span<const Point> points_base, const Pose& T_map_base, double path_m);
  // Forgets voxels last seen before path_m.
  void ForgetBefore(double path_m);

  // The voxel with a normal whose mean is nearest, among the point's own and the 26 around it; null: none.
  const Voxel* Nearest(const Eigen::Vector3f& point_map) const;
  const std::vector<Voxel>& voxels() const { return voxels_; }
  const VoxelMapConfig& config() const { return config_; }

 private:
  using Cell = std::array<std::int32_t, 3>;
  Cell CellOf(const Eigen::Vector3d& point_map) const;
  Eigen::Vector3d Centre(const Cell& cell) const;
  std::int32_t Find(const Cell& cell) const;  // -1: empty
  Voxel& FindOrAdd(const Cell& cell);
  void Rehash(std::size_t slots);
  void UpdateSurface(Voxel& voxel) const;

  VoxelMapConfig config_;
  std::vector<Voxel> voxels_;               // in order of creation: the same whatever the table's size
  std::vector<std::int32_t> slots_;         // open addressing, linear probing; index into voxels_ or -1
};

// One point a voxel of that edge: mean position, of the first point's sigma and colour. In order of first appearance.
std::vector<Point> Downsample(std::span<const Point> points, double voxel_m);

}  // namespace merlin
