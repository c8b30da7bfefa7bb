// The rigid motion that brings one set of points closest to another, pair by pair: the thesis' step of the ICP
// (eq. 5.18-5.37; Arun, Huang and Blostein 1987), with the reflection of planar or noisy sets turned back (Umeyama
// 1991).
#pragma once

#include <Eigen/Core>
#include <span>

#include "robot/types/se3.h"

namespace merlin {

struct PointPair {
  Eigen::Vector3d source, target;
  double weight = 1.0;  // >= 0
};

// T_target_source of least sum of weight * |target - T source|^2. A proper rotation always; where the pairs hold it
// only in part (one point, a line) one of the best. Identity without pairs or weight.
Pose FitRigid(std::span<const PointPair> pairs);

}  // namespace merlin
