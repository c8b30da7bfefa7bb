// Where the car will be when it can no longer stop: the strip of ground, as wide as the car with its margins, that the
// camera must have looked at lately.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

namespace merlin {

// Points across the path, from its right edge to its left one, in the base frame.
using PathAcross = std::array<Eigen::Vector2d, 5>;

// At distance_m along the path, or at its end where it is shorter; half_width_m to either side. path_base: at least one
// position, in the base frame and in driving order.
PathAcross AcrossPath(std::span<const Eigen::Vector2d> path_base, double distance_m, double half_width_m);

}  // namespace merlin
