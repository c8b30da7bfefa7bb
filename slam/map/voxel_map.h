// A sparse map of cubic voxels, in the map frame. Each voxel keeps the weighted moments of the points that fell into
// it. From its own and those of its 26 neighbours it has a surface: mean, and a normal where they are flat. Points that
// are not finite, or beyond 1000 km, are left out.
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
  double voxel_m = 0.1;  // [0.005, 2] edge; larger: faster, and points find surfaces farther away; smaller: sharper
  double flatness_max = 0.1;  // [0, 1] smallest over middle eigenvalue up to which a neighbourhood is a plane; guess
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
  int count = 0;                 // of points
  double weight = 0.0;           // sum of their 1 / sigma^2, in units of 1 / cm^2
  Eigen::Vector3d sum{0, 0, 0};  // weighted, relative to the voxel's centre
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d bgr_sum{0, 0, 0};  // weighted by color_weight
  double color_weight = 0.0;         // 0: without colour
  double last_seen_m = 0.0;          // distance driven when a point last fell in
  Eigen::Vector3f mean{0, 0, 0};     // in the map frame
  Eigen::Vector3f normal{0, 0, 0};   // unit, either sign; zero: the neighbourhood is no plane
  bool has_normal() const { return !normal.isZero(); }
  bool has_color() const { return color_weight > 0.0; }
  Eigen::Vector3d bgr() const { return bgr_sum / color_weight; }  // [0, 255]; of a voxel with colour
};

// The points of one frame, and its pose.
struct PlacedPoints {
  std::span<const Point> points_base;
  Pose T_map_base = Pose::Identity();
};

class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapConfig& config) : config_(config) {}

  // path_m: distance driven so far; becomes the last_seen_m of the voxels.
  void Insert(std::span<const Point> points_base, const Pose& T_map_base, double path_m);
  // The same as one Insert after the other, bit by bit, but faster: a voxel's surface is computed once, after the last
  // frame that has points in it.
  void InsertAll(std::span<const PlacedPoints> frames, double path_m);
  // Colours the existing voxels by the points that have a colour. A point weighs (cos(incidence) / distance^2)^2, the
  // square of the number of pixels per area, so that few near frontal views outweigh many far oblique ones. A voxel
  // without a normal counts as facing the camera. camera_base: where the rays begin.
  void Paint(std::span<const Point> points_base, const Eigen::Vector3f& camera_base, const Pose& T_map_base);
  // Forgets voxels last seen before path_m.
  void ForgetBefore(double path_m);
  // Forgets voxels by a flag each; the normals of their neighbours stay.
  void Forget(const std::vector<bool>& voxels);

  // The voxel with a normal whose mean is nearest, among the point's own voxel and the 26 around it. Null where none
  // has. For many points near each other: slam/map/nearest_search.h.
  const Voxel* Nearest(const Eigen::Vector3f& point_map) const;
  const std::vector<Voxel>& voxels() const { return voxels_; }
  const VoxelMapConfig& config() const { return config_; }

  // False for points that have no cell: too far out, or not finite.
  static bool InReach(const Eigen::Vector3f& point) { return (point.array().abs() < 1e6f).all(); }

  using Cell = std::array<std::int32_t, 3>;  // number of the voxel along x, y and z
  // Multiplies by large odd numbers and mixes (Teschner et al. 2003, with a final avalanche step).
  static std::size_t HashOf(const Cell& cell) {
    std::uint64_t h = static_cast<std::uint32_t>(cell[0]) * 0x9E3779B185EBCA87ull ^
                      static_cast<std::uint32_t>(cell[1]) * 0xC2B2AE3D27D4EB4Full ^
                      static_cast<std::uint32_t>(cell[2]) * 0x165667B19E3779F9ull;
    h ^= h >> 29;
    h *= 0xBF58476D1CE4E5B9ull;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
  // The same as ==, which compilers turn into a slower call of memcmp.
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

// One point per voxel of that edge: mean position, sigma and colour of its first point. In the order of first
// appearance.
std::vector<Point> Downsample(std::span<const Point> points, double voxel_m);

}  // namespace merlin
