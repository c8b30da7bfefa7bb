// A sparse map of cubic voxels. Each voxel keeps the weighted moments of the points that fell into it; with its 26
// neighbours they give a surface: mean, normal, flatness. Points that are not finite, or beyond 1000 km, are left out.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "perception/observation.h"
#include "robot/base/config.h"
#include "robot/types/se3.h"

namespace merlin {

struct VoxelMapConfig {
  double voxel_m = 0.1;       // [0.005, 2] edge; larger is faster and reaches farther, smaller is sharper
  double flatness_max = 0.1;  // [0, 1] smallest over middle eigenvalue of a neighbourhood that counts as a plane; guess
  int plane_points_min = 6;   // [3, 1000] points a neighbourhood needs for a plane; guess
};

template <class Visitor>
void Visit(Visitor& v, VoxelMapConfig& c) {
  v("voxel_m", c.voxel_m, {0.005, 2.0});
  v("flatness_max", c.flatness_max, {0.0, 1.0});
  v("plane_points_min", c.plane_points_min, {3.0, 1000.0});
}

struct Voxel {
  std::array<std::int32_t, 3> cell{};
  int count = 0;                 // points that fell in
  double weight = 0.0;           // their sum of 1 / sigma^2, 1 at 1 cm
  Eigen::Vector3d sum{0, 0, 0};  // weighted, relative to the voxel's centre
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d bgr_sum{0, 0, 0};  // weighted by color_weight
  double color_weight = 0.0;         // 0: without colour
  double last_seen_m = 0.0;          // path length at which a point last fell in
  Eigen::Vector3f mean{0, 0, 0};     // in the map frame
  Eigen::Vector3f normal{0, 0, 0};   // unit, either sign; zero: the neighbourhood is no plane
  bool has_normal() const { return !normal.isZero(); }
  bool has_color() const { return color_weight > 0.0; }
  Eigen::Vector3d bgr() const { return bgr_sum / color_weight; }  // [0, 255]; of a voxel with colour
};

// What one frame saw, and from where.
struct PlacedPoints {
  std::span<const Point> points_base;
  Pose T_map_base = Pose::Identity();
};

class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapConfig& config) : config_(config) {}

  // path_m: length driven so far, remembered as the voxels' last_seen_m.
  void Insert(std::span<const Point> points_base, const Pose& T_map_base, double path_m);
  // As one Insert after the other, with the same bits, but a voxel's surface is computed only once: after the last frame
  // that has points in it.
  void InsertAll(std::span<const PlacedPoints> frames, double path_m);
  // Colours from the points that have one, for the voxels there are: the best views decide. One weighs (cos(incidence) /
  // distance^2)^2, which is the square of how many pixels there are to an area, so that few frames from near and in front
  // outweigh many from far and aslant. A voxel that is no plane counts as facing. camera_base: where the rays begin.
  void Paint(std::span<const Point> points_base, const Eigen::Vector3f& camera_base, const Pose& T_map_base);
  // Forgets voxels last seen before path_m.
  void ForgetBefore(double path_m);
  // Forgets those that are true, one a voxel. Normals of what stood beside them stay.
  void Forget(const std::vector<bool>& voxels);

  // The voxel with a normal whose mean is nearest, among the point's own and the 26 around it; null: none.
  // For many points near each other: slam/map/nearest_search.h.
  const Voxel* Nearest(const Eigen::Vector3f& point_map) const;
  const std::vector<Voxel>& voxels() const { return voxels_; }
  const VoxelMapConfig& config() const { return config_; }

  // Points farther out, or not finite, have no cell: they are left out.
  static bool InReach(const Eigen::Vector3f& point) { return (point.array().abs() < 1e6f).all(); }

  using Cell = std::array<std::int32_t, 3>;  // a table of cells is made of these three
  // Multiplies by large odd numbers and mixes (Teschner et al. 2003, with a final avalanche step).
  static std::size_t HashOf(const Cell& cell) {
    std::uint64_t h = static_cast<std::uint32_t>(cell[0]) * 0x9E3779B185EBCA87ull ^
                      static_cast<std::uint32_t>(cell[1]) * 0xC2B2AE3D27D4EB4Full ^
                      static_cast<std::uint32_t>(cell[2]) * 0x165667B19E3779F9ull;
    h ^= h >> 29;
    h *= 0xBF58476D1CE4E5B9ull;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
  // As ==, which compilers turn into a call of memcmp.
  static bool Same(const Cell& a, const Cell& b) { return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0; }

 private:
  friend class NearestSearch;
  struct Slot {
    Cell cell{};
    std::int32_t index = -1;  // into voxels_; -1: free
  };
  // The indices of the voxels with a normal among the cell and the 26 around it, in one order always.
  template <class Function>
  void ForSurfacesAround(const Cell& cell, Function function) const {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const std::int32_t index = Find({cell[0] + dx, cell[1] + dy, cell[2] + dz});
          if (index >= 0 && voxels_[static_cast<std::size_t>(index)].has_normal()) function(index);
        }
  }
  Cell CellOf(const Eigen::Vector3d& point_map) const;
  Eigen::Vector3d Centre(const Cell& cell) const;
  // -1: empty.
  std::int32_t Find(const Cell& cell) const {
    if (slots_.empty()) return -1;
    for (std::size_t slot = HashOf(cell) & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1))
      if (slots_[slot].index < 0 || Same(slots_[slot].cell, cell)) return slots_[slot].index;
  }
  std::int32_t FindOrAdd(const Cell& cell);
  void MakeTable();
  void Enter(std::int32_t index);
  void UpdateSurface(Voxel& voxel) const;

  VoxelMapConfig config_;
  std::vector<Voxel> voxels_;  // in order of creation: the same whatever the table's size
  std::vector<Slot> slots_;    // open addressing, linear probing; a power of two
};

// One point a voxel of that edge: mean position, of the first point's sigma and colour. In order of first appearance.
std::vector<Point> Downsample(std::span<const Point> points, double voxel_m);

}  // namespace merlin
