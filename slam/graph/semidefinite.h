// Information matrices as they must be. Compiled once: Eigen's solver costs a compiler 5 s a file.
#pragma once

#include <optional>

#include "robot/types/se3.h"

namespace merlin {

// Nothing for a symmetric matrix that is positive semidefinite: no eigenvalue below -tolerance of the largest, in magnitude.
// Else the nearest that is (in Frobenius' norm): negative eigenvalues set to zero.
std::optional<Matrix6d> MadeSemidefinite(const Matrix6d& symmetric, double tolerance);

}  // namespace merlin
