#include "slam/register/cloud.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace merlin {
namespace {

using Cell = std::array<double, 3>;  // whole numbers; a double can hold that of every finite coordinate

Cell CellOf(const Eigen::Vector3d& position, double voxel_m) {
  const Eigen::Vector3d cell = (position / voxel_m).array().floor() + 0.0;  // no -0, whose bits differ from those of 0
  return {cell.x(), cell.y(), cell.z()};
}

std::uint64_t Hash(const Cell& cell) {
  std::uint64_t hash = 0;
  for (const double number : cell)
    hash = std::rotl(hash, 21) ^ (std::bit_cast<std::uint64_t>(number) * 0x9e3779b97f4a7c15u);
  return (hash * 0xbf58476d1ce4e5b9u) >> 20;
}

// Numbers cells 0, 1, 2, ... in the order of first appearance: a hash table with linear probing.
class CellNumbers {
 public:
  explicit CellNumbers(std::size_t cells_max) : slots_(std::bit_ceil(2 * cells_max + 1), kEmpty) {}

  std::uint32_t operator()(const Cell& cell) {
    const std::size_t last = slots_.size() - 1;
    for (std::size_t at = Hash(cell) & last;; at = (at + 1) & last) {
      if (slots_[at] == kEmpty) {
        slots_[at] = static_cast<std::uint32_t>(cells_.size());
        cells_.push_back(cell);
        return slots_[at];
      }
      if (cells_[slots_[at]] == cell) return slots_[at];
    }
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffffu;
  std::vector<std::uint32_t> slots_;
  std::vector<Cell> cells_;
};

// Sums of differences from the cell's first point, so that no digits are lost far from the origin.
struct Sum {
  Eigen::Vector3d first, differences = Eigen::Vector3d::Zero();
  double sigma_m = 0.0;
  double count = 0.0;
};

// More points make registration slower, but hardly more exact.
constexpr std::size_t kThinPointsMax = 20'000;
constexpr double kVoxelShareMin = 1e-3;

}  // namespace

Cloud Thin(const Cloud& cloud, double voxel_m) {
  CellNumbers numbers(cloud.size());
  std::vector<Sum> sums;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t cell = numbers(CellOf(cloud.positions[i], voxel_m));
    if (cell == sums.size()) sums.push_back({.first = cloud.positions[i]});
    Sum& sum = sums[cell];
    sum.differences += cloud.positions[i] - sum.first;
    sum.sigma_m += cloud.Sigma_m(i);
    ++sum.count;
  }
  Cloud thin;
  for (const Sum& sum : sums) {
    thin.positions.push_back(sum.first + sum.differences / sum.count);
    if (!cloud.sigma_m.empty()) thin.sigma_m.push_back(sum.sigma_m / sum.count);
  }
  return thin;
}

double Diagonal_m(const Cloud& cloud) {
  if (cloud.size() == 0) return 0.0;
  Eigen::Vector3d least = cloud.positions.front(), most = least;
  for (const Eigen::Vector3d& position : cloud.positions) {
    least = least.cwiseMin(position);
    most = most.cwiseMax(position);
  }
  return (most - least).norm();
}

ThinPair ThinToFit(const Cloud& source, const Cloud& target) {
  ThinPair pair{source, target, 0.0};
  const auto many = [&] { return std::max(pair.source.size(), pair.target.size()) > kThinPointsMax; };
  double voxel_m = kVoxelShareMin * std::max(Diagonal_m(source), Diagonal_m(target));
  for (; many() && voxel_m > 0.0; voxel_m *= std::numbers::sqrt2)
    pair = {Thin(source, voxel_m), Thin(target, voxel_m), voxel_m};
  return pair;
}

Eigen::Vector3d Centroid(const Cloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& position : cloud.positions) sum += position - cloud.positions.front();
  return cloud.positions.front() + sum / static_cast<double>(cloud.size());
}

}  // namespace merlin
