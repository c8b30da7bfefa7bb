// The sub-rays of all pixels as one image, and the parts of it that see only one plane. There nothing needs to be
// traced again when the camera moves a little: the range of a known plane takes one division.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/rays/ray_scene.h"
#include "sim/tof/optics.h"

namespace merlin::sim {

// Three times (or once) as wide and high as the image of pixels.
struct SubGrid {
  explicit SubGrid(const Optics& optics);
  std::size_t SubRay(int x, int y) const {
    return row_begin[static_cast<std::size_t>(y)] + in_row[static_cast<std::size_t>(x)];
  }
  int edge, width, height;
  std::vector<std::size_t> row_begin, in_row;  // of the index
};

// For each sub-ray: 1 if all sub-rays within `reach` in x and y hit the same plane as it does, or nothing as it does; 0
// otherwise, and near the edge of the image.
std::vector<std::uint8_t> CalmSubRays(const SubGrid& grid, std::span<const RayHit> hits, int reach);

// Range of a face along a unit direction.
float Range_m(const Face& face, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction);

}  // namespace merlin::sim
