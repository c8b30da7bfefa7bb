#include "slam/map/nearest_search.h"

#include <bit>
#include <cmath>
#include <utility>

namespace merlin {

NearestSearch::NearestSearch(const VoxelMap& map, std::size_t expected_points)
    : map_(map), slots_(std::bit_ceil(std::max<std::size_t>(64, expected_points))) {
  candidates_.reserve(8 * expected_points);
}

const Voxel* NearestSearch::Nearest(const Eigen::Vector3f& point_map) {
  if (!VoxelMap::InReach(point_map)) return nullptr;
  const Around& around = LookUp(map_.CellOf(point_map.cast<double>()));
  float best = HUGE_VALF;
  std::int32_t nearest = -1;
  for (const Candidate *c = candidates_.data() + around.begin, *end = c + around.count; c != end; ++c) {
    const float distance = (c->mean - point_map).squaredNorm();
    nearest = distance < best ? c->voxel : nearest;
    best = distance < best ? distance : best;
  }
  return nearest < 0 ? nullptr : &map_.voxels()[static_cast<std::size_t>(nearest)];
}

const NearestSearch::Around& NearestSearch::LookUp(const VoxelMap::Cell& cell) {
  std::size_t slot = VoxelMap::HashOf(cell) & (slots_.size() - 1);
  while (slots_[slot].count >= 0 && !VoxelMap::Same(slots_[slot].cell, cell)) slot = (slot + 1) & (slots_.size() - 1);
  if (slots_[slot].count >= 0) return slots_[slot];
  if (2 * ++used_ > slots_.size()) {
    Grow();
    --used_;
    return LookUp(cell);
  }
  Around& around = slots_[slot];
  around = {.cell = cell, .count = 0, .begin = candidates_.size()};
  map_.ForSurfacesAround(cell, [&](std::int32_t index) {
    candidates_.push_back({map_.voxels()[static_cast<std::size_t>(index)].mean, index});
    ++around.count;
  });
  return around;
}

void NearestSearch::Grow() {
  std::vector<Around> old(2 * slots_.size());
  std::swap(old, slots_);
  for (const Around& around : old) {
    if (around.count < 0) continue;
    std::size_t slot = VoxelMap::HashOf(around.cell) & (slots_.size() - 1);
    while (slots_[slot].count >= 0) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = around;
  }
}

}  // namespace merlin
