// The size of a mapped room against its plan.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "robot/types/se3.h"
#include "scenarios/judge/map_point.h"
#include "scenarios/judge/outline.h"

namespace merlin {

// Two distances between opposite outer walls: [0] from the wall of the outline's first edge, [1] from that of its
// second. None if the outline has no such pair, or the map shows too little of one of the walls.
struct MapSize {
  std::array<std::optional<double>, 2> plan_m;  // the same distances in the outline
  std::array<std::optional<double>, 2> size_m;
  std::array<std::optional<double>, 2> error_percent;  // |size - plan| / plan
};

// Finds the position of a wall in the map in these steps:
//  1. Select the map points 0.3 to 2.0 m above the floor (z = 0 in the world) and within 1.5 m of the outline's wall,
//     whose normal (from neighbours within 0.15 m) is within 20 degrees of the wall's.
//  2. Find the peak of the histogram of their distances from the line of the wall (2 cm bins with edges at multiples of
//     2 cm; the first of equal peaks).
//  3. Take the mean of the distances within 0.10 m of the middle of the peak bin. This is the least-squares plane
//     parallel to the wall. With fewer than 50 such points the wall is not known.
// The wall opposite an edge is the farthest of those that run in the opposite direction within 1 degree.
MapSize MeasureMapSize(std::span<const MapPoint> map, const Pose& T_world_map, const Outline& outline);

}  // namespace merlin
