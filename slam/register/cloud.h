// A free cloud: points that belong to no map and no camera, such as those of a file. Its coordinates are doubles, because
// files may have those of a national grid, millions of metres from the origin.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace merlin {

struct Cloud {
  std::vector<Eigen::Vector3d> positions;  // [m], finite, within +-1e9
  std::vector<double> sigma_m;             // one standard deviation per point, > 0; empty: unknown, and equal for all
  std::size_t size() const { return positions.size(); }
  // Where the sigmas are unknown only their ratios count, so any number will do.
  double Sigma_m(std::size_t i) const { return sigma_m.empty() ? 0.01 : sigma_m[i]; }
};

// One point per voxel of that edge [m], > 0: mean position and mean sigma. In the order of first appearance.
Cloud Thin(const Cloud& cloud, double voxel_m);

struct ThinPair {
  Cloud source, target;
  double voxel_m = 0.0;  // 0: unchanged
};

// Thins both with the same voxel until neither has more than 20,000 points, which take about 0.1 s to register. The
// voxel starts at 1/1000 of the longer diagonal and grows by sqrt(2).
ThinPair ThinToFit(const Cloud& source, const Cloud& target);

// Diagonal of the box around the points; 0 without points.
double Diagonal_m(const Cloud& cloud);

// The mean position of at least one point.
Eigen::Vector3d Centroid(const Cloud& cloud);

}  // namespace merlin
