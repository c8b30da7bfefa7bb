// The sub-rays of all pixels as one picture, and the parts of it where only one plane is seen. There nothing needs to be
// traced again when the camera moves a little: where a ray meets a known plane is one division.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/rays/ray_scene.h"
#include "sim/tof/optics.h"

namespace merlin::sim {

// Three times (or once) as wide and high as the pixels' picture.
struct SubGrid {
  explicit SubGrid(const Optics& optics);
  std::size_t SubRay(int x, int y) const {
    return row_begin[static_cast<std::size_t>(y)] + in_row[static_cast<std::size_t>(x)];
  }
  int edge, width, height;
  std::vector<std::size_t> row_begin, in_row;  // of the index
};

// For each sub-ray; 1: all sub-rays up to reach away in x and y meet the same plane as it does, or nothing as it does; 0
// also near the picture's edge.
std::vector<std::uint8_t> CalmSubRays(const SubGrid& grid, std::span<const RayHit> hits, int reach);

// Range of a face along a unit direction.
float Range_m(const Face& face, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction);

}  // namespace merlin::sim
