// Repairs information matrices that are not positive semidefinite. A file of its own, because Eigen's eigenvalue solver
// takes 5 s to compile.
#pragma once

#include <optional>

#include "robot/types/se3.h"

namespace merlin {

// Nothing for a symmetric matrix that is positive semidefinite: no eigenvalue is below -tolerance times the largest
// magnitude. Otherwise the nearest matrix that is, in the Frobenius norm: its negative eigenvalues are set to zero.
std::optional<Matrix6d> MadeSemidefinite(const Matrix6d& symmetric, double tolerance);

}  // namespace merlin
