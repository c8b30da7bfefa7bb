// Thins the points of a frame for registration, so that a frame costs much the same whatever its number of pixels and its
// view.
#pragma once

#include <span>
#include <vector>

#include "perception/observation.h"

namespace merlin {

// One point per voxel of that edge (slam/map/voxel_map.h, Downsample). A frame of a narrow lens fills few voxels, close
// to a wall only some dozens: there the edge shrinks, by a factor sqrt(2) a time, until at least points_min are left or
// the frame has no more.
std::vector<Point> ThinSource(std::span<const Point> points, double voxel_m, int points_min);

}  // namespace merlin
