// Counts laps around a room from the true path.
#pragma once

#include "robot/types/trajectory.h"
#include "scenarios/judge/outline.h"

namespace merlin {

// A lap: the path winds once around the centroid of the outline, in either direction, and crosses the starting line
// again. The width of the corridor and the lane do not matter.
//
// The starting line runs from the centre to the start and on to infinity:
//
//            e---------c   c  the centre
//            |             e  as far from the start as the outer wall is, but on its inner side
//   corridor s             s  the start; from e outwards the line stands square to the nearest outer wall
//   ---------+---------    outer wall
//
// Driving back unwinds the path. A path that comes within 0.1 m of the centre does not wind around it, so the lap under
// way starts again there. After a lap the next one begins at the line, in either direction. Positions that are not
// finite are skipped. Returns 0 if the outline is missing or has no area.
int CountLaps(const Trajectory& truth, const Outline& outline);

}  // namespace merlin
