#include "slam/graph/semidefinite.h"

#include <Eigen/Eigenvalues>

namespace merlin {

std::optional<Matrix6d> MadeSemidefinite(const Matrix6d& symmetric, double tolerance) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(symmetric);
  const Vector6d values = solver.eigenvalues();
  if (values.minCoeff() >= -tolerance * values.cwiseAbs().maxCoeff()) return std::nullopt;
  const Matrix6d& V = solver.eigenvectors();
  const Matrix6d made = V * values.cwiseMax(0.0).asDiagonal() * V.transpose();
  return 0.5 * (made + made.transpose());
}

}  // namespace merlin
