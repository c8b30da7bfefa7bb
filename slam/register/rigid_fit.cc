#include "slam/register/rigid_fit.h"

#include <Eigen/SVD>

namespace merlin {

Pose FitRigid(std::span<const PointPair> pairs) {
  double weight = 0.0;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero(), target_mean = Eigen::Vector3d::Zero();
  for (const PointPair& pair : pairs) {
    weight += pair.weight;
    source_mean += pair.weight * pair.source;
    target_mean += pair.weight * pair.target;
  }
  Pose T = Pose::Identity();
  if (!(weight > 0.0)) return T;
  source_mean /= weight;  // centroids, then the cross-covariance about them, then its SVD
  target_mean /= weight;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (const PointPair& pair : pairs)
    cross += pair.weight * (pair.target - target_mean) * (pair.source - source_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  T.linear() = svd.matrixU() * Eigen::Vector3d(1.0, 1.0, handedness).asDiagonal() * svd.matrixV().transpose();
  T.translation() = target_mean - T.linear() * source_mean;
  return T;
}

}  // namespace merlin
