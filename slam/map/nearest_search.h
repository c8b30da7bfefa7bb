// VoxelMap::Nearest for many points near each other, as in a registration. The voxels around a cell are looked up once
// and kept.
#pragma once

#include <cstdint>
#include <vector>

#include "slam/map/voxel_map.h"

namespace merlin {

class NearestSearch {
 public:
  // The map must outlive this and must not change. expected_points only reserves memory.
  NearestSearch(const VoxelMap& map, std::size_t expected_points);

  // The same voxel as map.Nearest(point_map).
  const Voxel* Nearest(const Eigen::Vector3f& point_map);

 private:
  struct Candidate {
    Eigen::Vector3f mean;
    std::int32_t voxel;
  };
  struct Around {
    std::array<std::int32_t, 3> cell{};
    std::int32_t count = -1;  // -1: nothing looked up here
    std::size_t begin = 0;    // of its candidates, in the order in which the map compares them
  };
  const Around& LookUp(const std::array<std::int32_t, 3>& cell);
  void Grow();

  const VoxelMap& map_;
  std::vector<Around> slots_;  // open addressing, linear probing; a power of two
  std::size_t used_ = 0;
  std::vector<Candidate> candidates_;
};

}  // namespace merlin
