// The rigid motion between two sets of paired points with the least squared distances: centroids, then the SVD of the
// cross-covariance (K. Arun, T. Huang and S. Blostein, "Least-squares fitting of two 3-D point sets", PAMI 9, 1987).
// For planar or noisy sets that may be a reflection, which is turned into a rotation (S. Umeyama, "Least-squares
// estimation of transformation parameters between two point patterns", PAMI 13, 1991).
#pragma once

#include <Eigen/Core>
#include <span>

#include "robot/types/se3.h"

namespace merlin {

struct PointPair {
  Eigen::Vector3d source, target;
  double weight = 1.0;  // >= 0
};

// T_target_source with the least sum of weight * |target - T source|^2. Always a proper rotation; where the pairs
// determine it only in part (one point, a line), one of the best. Identity without pairs or weight.
Pose FitRigid(std::span<const PointPair> pairs);

}  // namespace merlin
