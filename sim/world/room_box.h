// The extent of a room, seen from above.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "sim/world/world.h"

namespace merlin::sim {

// Bounding box of the floor plan [m], x and y in the world frame. It holds all geoms except those of the car, actors
// and obstacles, and except infinite planes. None if there are no such geoms, or if the car stands outside the box.
std::optional<Eigen::AlignedBox2d> RoomBox_m(const World& world);

// The corners of the room's plan ("plan_xy_m") if it has one, else of its box; empty if there is no box either.
std::vector<Eigen::Vector2d> RoomOutline_m(const World& world);

// Whether the straight line between two points lies entirely within the outline (a simple polygon).
bool HoldsLine(const std::vector<Eigen::Vector2d>& outline_m, const Eigen::Vector2d& from_m,
               const Eigen::Vector2d& to_m);

}  // namespace merlin::sim
