#include "slam/register/undetermined.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace merlin {
namespace {

// A motion with less than this share of the largest variance moves no point: a line that turns about itself.
constexpr double kMovesNothing = 1e-9;

}  // namespace

Shares SplitIntoShares(const PairSums& sums) {
  Shares result;
  const double translation = sums.whole.topLeftCorner<3, 3>().trace();
  const double rotation = sums.whole.bottomRightCorner<3, 3>().trace();
  if (!(translation > 0.0) || !std::isfinite(translation + rotation) || !sums.information.allFinite()) return result;
  // Rotations in metres at the mean lever arm, so that kMovesNothing has one scale.
  Vector6d scale = Vector6d::Ones();
  if (rotation > 0.0) scale.tail<3>().setConstant(std::sqrt(translation / rotation));
  const Eigen::SelfAdjointEigenSolver<Matrix6d> whole(scale.asDiagonal() * sums.whole * scale.asDiagonal());
  // In the basis where `whole` is the identity, the eigenvalues of the information are the shares.
  Matrix6d equal = scale.asDiagonal() * whole.eigenvectors();
  int still = 0;
  for (int i = 0; i < 6; ++i) {
    const double moved = whole.eigenvalues()(i);
    if (moved <= kMovesNothing * whole.eigenvalues()(5))
      ++still;  // eigenvalues ascend: these come first
    else
      equal.col(i) /= std::sqrt(moved);
  }
  Matrix6d share = equal.transpose() * sums.information * equal;
  share.topRows(still).setZero();
  share.leftCols(still).setZero();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(share);
  result.shares = solver.eigenvalues();
  result.motions = equal * solver.eigenvectors();
  return result;
}

Undetermined FindUndetermined(const Shares& shares) {
  const auto count = (shares.shares.array() < kHeldShareMin).count();
  Undetermined undetermined;
  undetermined.directions = shares.motions.leftCols(count).colwise().normalized();
  return undetermined;
}

Vector6d StepWhereHeld(const Shares& shares, const Vector6d& gradient) {
  Vector6d step = Vector6d::Zero();
  for (int i = 0; i < 6; ++i)
    if (shares.shares(i) >= kHeldShareMin)
      step -= shares.motions.col(i).dot(gradient) / shares.shares(i) * shares.motions.col(i);
  return step;
}

}  // namespace merlin
