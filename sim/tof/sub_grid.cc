#include "sim/tof/sub_grid.h"

#include <algorithm>
#include <cmath>

namespace merlin::sim {

SubGrid::SubGrid(const Optics& optics)
    : edge(optics.per_pixel == 1 ? 1 : kSubRaysPerEdge), width(optics.width * edge), height(optics.height * edge) {
  const std::size_t n = static_cast<std::size_t>(edge), pixels = static_cast<std::size_t>(optics.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
    row_begin.push_back(y / n * pixels * n * n + y % n * n * pixels);
  for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) in_row.push_back(x % n * pixels + x / n);
}

std::vector<std::uint8_t> CalmSubRays(const SubGrid& grid, std::span<const RayHit> hits, int reach) {
  std::vector<std::uint8_t> calm(hits.size(), 0);
  if (reach < 0 || 2 * reach >= std::min(grid.width, grid.height)) return calm;
  // For each column: the face in this row and in the row above, and for how many rows up to this one the sub-ray and
  // its neighbours within reach have all been of this one face.
  std::vector<int> face(static_cast<std::size_t>(grid.width)), above(face.size()), tall(face.size(), 0);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) face[static_cast<std::size_t>(x)] = hits[grid.SubRay(x, y)].face;
    for (int begin = 0; begin < grid.width;) {
      const int of_run = face[static_cast<std::size_t>(begin)];
      int end = begin + 1;
      while (end < grid.width && face[static_cast<std::size_t>(end)] == of_run) ++end;
      for (int x = begin; x < end; ++x) {
        const std::size_t column = static_cast<std::size_t>(x);
        const bool wide = of_run != kCurvedFace && x - begin >= reach && end - 1 - x >= reach;
        tall[column] = !wide ? 0 : y > 0 && above[column] == of_run ? tall[column] + 1 : 1;
        if (tall[column] > 2 * reach) calm[grid.SubRay(x, y - reach)] = 1;
      }
      begin = end;
    }
    std::swap(face, above);
  }
  return calm;
}

float Range_m(const Face& face, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
  constexpr float kGrazing = 1e-6f;
  const float toward = face.normal.dot(direction), away_m = face.offset_m - face.normal.dot(origin);
  return std::abs(away_m) / std::max(std::abs(toward), kGrazing);
}

}  // namespace merlin::sim
