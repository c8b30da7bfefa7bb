// The size of a mapped room against its plan.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "robot/types/se3.h"
#include "scenarios/judge/map_point.h"
#include "scenarios/judge/outline.h"

namespace merlin {

// Two distances between opposite outer walls: [0] of the outline's first edge, [1] of its second. Empty where the
// outline has no such pair, or the map shows too little of one of its walls.
struct MapSize {
  std::array<std::optional<double>, 2> plan_m;  // the same distances in the outline
  std::array<std::optional<double>, 2> size_m;
  std::array<std::optional<double>, 2> error_percent;  // |size - plan| / plan
};

// A wall's place in the map: of the points 0.3 to 2.0 m above the floor (z = 0 in the world), within 1.5 m of the
// outline's wall and with a normal (from neighbours within 0.15 m) within 20 degrees of its, take the distances from
// the wall's line; the peak of their histogram (2 cm bins, edges at multiples of 2 cm, the first of equals); then the
// plane parallel to the wall that fits those within 0.10 m of the peak bin's middle in the least squares, which is at
// their mean. Fewer than 50 of those: the wall is not known. The wall opposite an edge is the farthest of those that
// run against its direction within 1 degree.
MapSize MeasureMapSize(std::span<const MapPoint> map, const Pose& T_world_map, const Outline& outline);

}  // namespace merlin
