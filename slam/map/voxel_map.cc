#include "slam/map/voxel_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace merlin {
namespace {

constexpr double kNearest_m = 0.5;  // nearer views count as from here, so that a single wrong one does not decide
constexpr double kGrazing = 0.01;   // least cosine, so that every voxel that was seen has a colour

double WeightOf(const Point& point) { return 1e-4 / std::max<double>(point.sigma_m * point.sigma_m, 1e-6); }

template <class Function>
void ForNeighbours(const std::array<std::int32_t, 3>& cell, Function function) {
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dz = -1; dz <= 1; ++dz) function(std::array<std::int32_t, 3>{cell[0] + dx, cell[1] + dy, cell[2] + dz});
}

}  // namespace

VoxelMap::Cell VoxelMap::CellOf(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d cell = (p / config_.voxel_m).array().floor();
  return {static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()),
          static_cast<std::int32_t>(cell.z())};
}

Eigen::Vector3d VoxelMap::Centre(const Cell& cell) const {
  return (Eigen::Vector3d(cell[0], cell[1], cell[2]).array() + 0.5) * config_.voxel_m;
}

std::int32_t VoxelMap::FindOrAdd(const Cell& cell) {
  if (const std::int32_t index = Find(cell); index >= 0) return index;
  voxels_.emplace_back().cell = cell;
  if (2 * voxels_.size() > slots_.size())
    MakeTable();
  else
    Enter(static_cast<std::int32_t>(voxels_.size()) - 1);
  return static_cast<std::int32_t>(voxels_.size()) - 1;
}

void VoxelMap::Enter(std::int32_t index) {
  std::size_t slot = HashOf(voxels_[index].cell) & (slots_.size() - 1);
  while (slots_[slot].index >= 0) slot = (slot + 1) & (slots_.size() - 1);
  slots_[slot] = {voxels_[index].cell, index};
}

void VoxelMap::MakeTable() {
  slots_.assign(std::bit_ceil(std::max<std::size_t>(1024, 4 * voxels_.size())), {});
  for (std::size_t i = 0; i < voxels_.size(); ++i) Enter(static_cast<std::int32_t>(i));
}

void VoxelMap::Insert(std::span<const Point> points_base, const Pose& T_map_base, double path_m) {
  const PlacedPoints frame{points_base, T_map_base};
  InsertAll(std::span(&frame, 1), path_m);
}

void VoxelMap::InsertAll(std::span<const PlacedPoints> frames, double path_m) {
  // The voxel of every point; -1: left out. New voxels are still empty, which their neighbours' surfaces do not notice.
  std::vector<std::int32_t> voxel_of;
  for (const PlacedPoints& frame : frames)
    for (const Point& point : frame.points_base) {
      const Eigen::Vector3d p_map = frame.T_map_base * point.position.cast<double>();
      const bool counts = InReach(p_map.cast<float>()) && WeightOf(point) > 0.0;  // an infinite sigma weighs nothing
      voxel_of.push_back(counts ? FindOrAdd(CellOf(p_map)) : -1);
    }
  constexpr std::int32_t kDone = -1;
  std::vector<std::int32_t> last_frame(voxels_.size(), kDone);  // that has points in the voxel
  std::size_t i = 0;
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t end = i + frames[f].points_base.size(); i < end; ++i)
      if (voxel_of[i] >= 0) last_frame[voxel_of[i]] = static_cast<std::int32_t>(f);

  i = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const std::size_t begin = i;
    for (const Point& point : frames[f].points_base) {
      const std::int32_t index = voxel_of[i++];
      if (index < 0) continue;
      Voxel& voxel = voxels_[index];
      const double weight = WeightOf(point);
      const Eigen::Vector3d d = frames[f].T_map_base * point.position.cast<double>() - Centre(voxel.cell);
      ++voxel.count;
      voxel.weight += weight;
      voxel.sum += weight * d;
      voxel.squares += weight * d * d.transpose();
    }
    for (std::size_t k = begin; k < i; ++k) {
      const std::int32_t index = voxel_of[k];
      if (index < 0 || last_frame[index] != static_cast<std::int32_t>(f)) continue;
      last_frame[index] = kDone;
      Voxel& voxel = voxels_[index];
      voxel.last_seen_m = path_m;
      voxel.mean = (Centre(voxel.cell) + voxel.sum / voxel.weight).cast<float>();
      UpdateSurface(voxel);
    }
  }
}

void VoxelMap::UpdateSurface(Voxel& voxel) const {
  // Moments of the 27 voxels about this voxel's centre.
  const Eigen::Vector3d centre = Centre(voxel.cell);
  int count = 0;
  double weight = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  ForNeighbours(voxel.cell, [&](const Cell& cell) {
    const std::int32_t index = Find(cell);
    if (index < 0) return;
    const Voxel& other = voxels_[index];
    const Eigen::Vector3d shift = Centre(cell) - centre;
    count += other.count;
    weight += other.weight;
    sum += other.sum + other.weight * shift;
    squares += other.squares + other.sum * shift.transpose() + shift * other.sum.transpose() +
               other.weight * shift * shift.transpose();
  });
  voxel.normal.setZero();
  if (count < config_.plane_points_min) return;
  const Eigen::Matrix3d covariance = squares / weight - (sum / weight) * (sum / weight).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d values = solver.eigenvalues();
  if (values(0) <= config_.flatness_max * values(1) && values(1) > 0.0)
    voxel.normal = solver.eigenvectors().col(0).cast<float>();
}

void VoxelMap::ForgetBefore(double path_m) {
  std::erase_if(voxels_, [path_m](const Voxel& voxel) { return voxel.last_seen_m < path_m; });
  MakeTable();
}

void VoxelMap::Forget(const std::vector<bool>& voxels) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < voxels_.size(); ++i)
    if (!voxels[i]) voxels_[kept++] = voxels_[i];
  voxels_.resize(kept);
  MakeTable();
}

void VoxelMap::Paint(std::span<const Point> points_base, const Eigen::Vector3f& camera_base, const Pose& T_map_base) {
  const Eigen::Vector3d camera_map = T_map_base * camera_base.cast<double>();
  for (const Point& point : points_base) {
    if (!point.has_color) continue;
    const Eigen::Vector3d p_map = T_map_base * point.position.cast<double>();
    if (!InReach(p_map.cast<float>())) continue;
    const std::int32_t index = Find(CellOf(p_map));
    if (index < 0) continue;
    Voxel& voxel = voxels_[static_cast<std::size_t>(index)];
    const Eigen::Vector3d ray = p_map - camera_map;
    const double square_m2 = std::max(ray.squaredNorm(), kNearest_m * kNearest_m);
    const double cosine =
        voxel.has_normal() ? std::abs(voxel.normal.cast<double>().dot(ray)) / std::sqrt(square_m2) : 1.0;
    const double weight = std::pow(std::max(cosine, kGrazing) / square_m2, 2);
    voxel.bgr_sum += weight * Eigen::Vector3d(point.bgr[0], point.bgr[1], point.bgr[2]);
    voxel.color_weight += weight;
  }
}

const Voxel* VoxelMap::Nearest(const Eigen::Vector3f& point_map) const {
  if (!InReach(point_map)) return nullptr;
  const Voxel* nearest = nullptr;
  float best = HUGE_VALF;
  ForSurfacesAround(CellOf(point_map.cast<double>()), [&](std::int32_t index) {
    const float distance = (voxels_[index].mean - point_map).squaredNorm();
    if (distance < best) {
      best = distance;
      nearest = &voxels_[index];
    }
  });
  return nearest;
}

std::vector<Point> Downsample(std::span<const Point> points, double voxel_m) {
  struct CellHash {
    std::size_t operator()(const std::array<std::int32_t, 3>& cell) const { return VoxelMap::HashOf(cell); }
  };
  std::unordered_map<std::array<std::int32_t, 3>, std::size_t, CellHash> index_of;
  index_of.reserve(points.size());
  std::vector<Point> out;
  std::vector<int> counts;
  for (const Point& point : points) {
    if (!VoxelMap::InReach(point.position)) continue;
    const Eigen::Vector3f cell = (point.position / static_cast<float>(voxel_m)).array().floor();
    const auto [it, added] = index_of.try_emplace(
        {static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()), static_cast<std::int32_t>(cell.z())},
        out.size());
    if (added) {
      out.push_back(point);
      counts.push_back(1);
    } else {
      out[it->second].position += point.position;
      ++counts[it->second];
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].position /= static_cast<float>(counts[i]);
  return out;
}

}  // namespace merlin
