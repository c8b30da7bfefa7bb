// A free cloud: points that came with no map and no camera. In doubles, since files give coordinates of national grids.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace merlin {

struct Cloud {
  std::vector<Eigen::Vector3d> positions;  // [m], finite, within +-1e9
  std::vector<double> sigma_m;             // one standard deviation of each point, > 0; empty: all alike, and unknown
  std::size_t size() const { return positions.size(); }
  // Where unknown only the ratios count: any number serves.
  double Sigma_m(std::size_t i) const { return sigma_m.empty() ? 0.01 : sigma_m[i]; }
};

// One point a voxel of that edge [m], > 0: mean position and mean sigma. In order of first appearance.
Cloud Thin(const Cloud& cloud, double voxel_m);

// The mean position; of at least one point.
Eigen::Vector3d Centroid(const Cloud& cloud);

}  // namespace merlin
