// Finds the motions that the geometry of a registration does not hold: a bare corridor does not tell the position along
// it. From the sums over all pairs, the eigenvalue problem information * x = share * whole * x gives six motions with
// the share of each that is held. J. Zhang, M. Kaess and S. Singh, "On degeneracy of optimization-based state
// estimation problems", ICRA 2016, do the same with eigenvalues of the information alone, which depend on units and
// origin.
#pragma once

#include "robot/types/se3.h"

namespace merlin {

// A motion counts as held where at least this share of the points' displacement (squared, weighted) is across their
// surfaces. Normals that err by 3 degrees give 0.3 % along a bare corridor; an end wall with one point in twenty gives
// 5 %. A guess between the two.
constexpr double kHeldShareMin = 0.01;

// Columns: twists (translation [m], rotation [rad]) of the moved frame, of length 1. No column: everything is held.
struct Undetermined {
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6> directions{6, 0};
  int count() const { return static_cast<int>(directions.cols()); }
};

// Sums over pairs, for a small motion x = (translation, rotation) of the frame that their points p are in.
struct PairSums {
  Matrix6d information = Matrix6d::Zero();  // sum of J' W J with J = [I, -Hat(p)]: what the pairs hold
  // Sum of tr(W) J' J: what they would hold if each held its point in every direction. Zero without pairs.
  Matrix6d whole = Matrix6d::Zero();
};

// The motions and their shares, independent of units and origin.
struct Shares {
  Vector6d shares = Vector6d::Zero();       // ascending, in [0, 1] for pairs on planes; 0 where no point moves
  Matrix6d motions = Matrix6d::Identity();  // columns; motion' * whole * motion = 1 where the share is above 0
};
Shares SplitIntoShares(const PairSums& sums);

Undetermined FindUndetermined(const Shares& shares);

// The Newton step -information^-1 * gradient within the held motions; zero along the others.
Vector6d StepWhereHeld(const Shares& shares, const Vector6d& gradient);

}  // namespace merlin
