// Where a room ends, seen from above.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "sim/world/world.h"

namespace merlin::sim {

// The floor plan's bounding box [m], x and y in the world's frame: of all geoms but the car's, actors', obstacles' and
// planes without end. Empty: there are none, or the car does not stand in it (the room lies beside the car).
std::optional<Eigen::AlignedBox2d> RoomBox_m(const World& world);

// The corners of the room's plan ("plan_xy_m"), else of its box. Empty: the room has no end.
std::vector<Eigen::Vector2d> RoomOutline_m(const World& world);

// Whether all of the straight line between two points lies within the outline (a simple polygon).
bool HoldsLine(const std::vector<Eigen::Vector2d>& outline_m, const Eigen::Vector2d& from_m,
               const Eigen::Vector2d& to_m);

}  // namespace merlin::sim
