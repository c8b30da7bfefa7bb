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

struct ThinPair {
  Cloud source, target;
  double voxel_m = 0.0;  // 0: as they were
};

// Both thinned by one voxel until neither has more than 20,000 points, which registration takes in about 0.1 s: the
// first that fits of 1/1000 of the longer diagonal, and sqrt(2) times as much each time.
ThinPair ThinToFit(const Cloud& source, const Cloud& target);

// Of the box around the points; 0 without any.
double Diagonal_m(const Cloud& cloud);

// The mean position; of at least one point.
Eigen::Vector3d Centroid(const Cloud& cloud);

}  // namespace merlin
