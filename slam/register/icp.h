// Registration of a frame against a map: point-to-plane ICP (Y. Chen and G. Medioni, "Object modelling by registration
// of multiple range images", Image and Vision Computing 10, 1992) with the kernel of Geman and McClure against
// outliers. The result is a maximum a posteriori estimate: a prior on the pose holds what the geometry does not, such
// as the position along a bare corridor.
//
//   frame  origin and axes
//   base   the car at the frame's stamp; points are given in it
//   map    the map's
#pragma once

#include <span>

#include "perception/observation.h"
#include "robot/base/config.h"
#include "robot/types/se3.h"
#include "slam/map/voxel_map.h"

namespace merlin {

struct IcpConfig {
  int iterations_max = 20;         // [1, 1000]
  double step_converged = 2e-4;    // [0, 1] m and rad; a smaller step ends the iteration
  double kernel_m = 0.05;          // [0.001, 10] residual at which the weight of a pair is a quarter; guess
  double map_sigma_m = 0.01;       // [0, 1] one sigma of the map's surface; guess
  double independent_share = 0.1;  // [0, 1] of the pairs that count as independent: neighbours err alike; guess
  int inliers_min = 60;            // [6, 1e9] pairs within two kernels; with fewer it has not converged
  double inlier_share_min = 0.3;   // [0, 1] their share of all pairs; below it has not converged
};

template <class Visitor>
void Visit(Visitor& v, IcpConfig& c) {
  v("iterations_max", c.iterations_max, {1.0, 1000.0});
  v("step_converged", c.step_converged, {0.0, 1.0});
  v("kernel_m", c.kernel_m, {0.001, 10.0});
  v("map_sigma_m", c.map_sigma_m, {0.0, 1.0});
  v("independent_share", c.independent_share, {0.0, 1.0});
  v("inliers_min", c.inliers_min, {6.0, 1e9});
  v("inlier_share_min", c.inlier_share_min, {0.0, 1.0});
}

// The expected pose. information: inverse covariance over (translation, rotation) in the base frame; zero where the
// pose is only a start.
struct PosePrior {
  Pose T_map_base = Pose::Identity();
  Matrix6d information = Matrix6d::Zero();
};

struct RegisterResult {
  Pose T_map_base = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  // over (translation, rotation) in the base frame
  int pairs = 0;                           // points that have a surface of the map nearby
  int inliers = 0;
  double inlier_share = 0.0;  // of the points that have a surface of the map nearby: new ground does not count
  double rms_m = 0.0;         // of the inliers' point-to-plane distances
  int iterations = 0;
  // The information about the position on the floor, in the direction that is known best, divided by the information about
  // the height. About 0 where only floor is seen, far above kHeldShareMin (undetermined.h) with a wall in view; infinite
  // without a floor.
  double level_share = 0.0;
  bool converged = false;  // false: the pose is the last iterate, and must not be trusted
};

// Starts at the prior's pose. origin_base: where the rays of the points begin. With too few points, or an empty map, it
// has not converged.
RegisterResult Register(std::span<const Point> points_base, const Eigen::Vector3f& origin_base, const VoxelMap& map,
                        const PosePrior& prior, const IcpConfig& config);

}  // namespace merlin
