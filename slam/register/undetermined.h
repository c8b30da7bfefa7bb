// Which motions the geometry of a registration does not hold: a bare corridor says nothing about the way along it.
#pragma once

#include "robot/types/se3.h"

namespace merlin {

// Of the way that a motion moves the pairs' points, the share (squared, weighted) that must be across their surfaces
// for the motion to count as held. Normals that err by 3 degrees make 0.3 % along a bare corridor; an end wall that
// takes one point in twenty makes 5 %. Guess, between the two.
constexpr double kHeldShareMin = 0.01;

// Columns: twists (translation [m], rotation [rad]) of the moved frame, of length 1. None: everything is held.
struct Undetermined {
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6> directions{6, 0};
  int count() const { return static_cast<int>(directions.cols()); }
};

// What pairs tell about a small motion x = (translation, rotation) of the frame that their points p are in.
struct PairSums {
  Matrix6d information = Matrix6d::Zero();  // sum of J' W J with J = [I, -Hat(p)]: what the pairs hold
  // Sum of tr(W) J' J: what they would, held on every side. Zero: no pairs.
  Matrix6d whole = Matrix6d::Zero();
};

// The motions with one share each, information = share * whole: independent of units and origin.
struct Shares {
  Vector6d shares = Vector6d::Zero();       // ascending, of a pair on a plane in [0, 1]; 0 where nothing moves
  Matrix6d motions = Matrix6d::Identity();  // columns; motion' * whole * motion = 1 where the share is above 0
};
Shares SplitIntoShares(const PairSums& sums);

Undetermined FindUndetermined(const Shares& shares);

// -information^-1 * gradient within the held motions; nothing along the others.
Vector6d StepWhereHeld(const Shares& shares, const Vector6d& gradient);

}  // namespace merlin
