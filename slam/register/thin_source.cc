#include "slam/register/thin_source.h"

#include <cmath>

#include "slam/map/voxel_map.h"

namespace merlin {
namespace {

constexpr double kFinest_m = 0.005;  // finer than any pixel covers at 2 m

}  // namespace

std::vector<Point> ThinSource(std::span<const Point> points, double voxel_m, int points_min) {
  std::vector<Point> thin = Downsample(points, voxel_m);
  while (static_cast<int>(thin.size()) < points_min && thin.size() < points.size() && voxel_m > kFinest_m) {
    voxel_m *= std::sqrt(0.5);
    thin = Downsample(points, voxel_m);
  }
  return thin;
}

}  // namespace merlin
