#include "slam/register/cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace merlin {
namespace {

using Cell = std::array<double, 3>;  // whole numbers; a double holds every one that a finite coordinate can give

Cell CellOf(const Eigen::Vector3d& position, double voxel_m) {
  const Eigen::Vector3d cell = (position / voxel_m).array().floor();
  return {cell.x(), cell.y(), cell.z()};
}

// The points' indices, those of one cell beside each other, each cell's in their order.
std::vector<std::uint32_t> ByCell(const std::vector<Cell>& cells) {
  std::vector<std::uint32_t> order(cells.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return cells[a] < cells[b]; });
  return order;
}

}  // namespace

Cloud Thin(const Cloud& cloud, double voxel_m) {
  std::vector<Cell> cells(cloud.size());
  std::ranges::transform(cloud.positions, cells.begin(), [&](const auto& p) { return CellOf(p, voxel_m); });
  const std::vector<std::uint32_t> order = ByCell(cells);
  std::vector<std::array<std::uint32_t, 3>> groups;  // first point, begin and end in the order
  for (std::uint32_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && cells[order[end]] == cells[order[begin]]) ++end;
    groups.push_back({order[begin], begin, end});
  }
  std::ranges::sort(groups);

  Cloud thin;
  for (const auto& [first, begin, end] : groups) {
    // Sums of differences from the first point: no digits lost far from the origin.
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double sigma_sum_m = 0.0;
    for (std::uint32_t i = begin; i < end; ++i) {
      sum += cloud.positions[order[i]] - cloud.positions[first];
      sigma_sum_m += cloud.Sigma_m(order[i]);
    }
    thin.positions.push_back(cloud.positions[first] + sum / (end - begin));
    if (!cloud.sigma_m.empty()) thin.sigma_m.push_back(sigma_sum_m / (end - begin));
  }
  return thin;
}

Eigen::Vector3d Centroid(const Cloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& position : cloud.positions) sum += position - cloud.positions.front();
  return cloud.positions.front() + sum / static_cast<double>(cloud.size());
}

}  // namespace merlin
