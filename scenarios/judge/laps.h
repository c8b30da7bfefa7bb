// Counts laps of a closed corridor from the true path.
#pragma once

#include "scenarios/judge/outline.h"
#include "scenarios/judge/trajectory.h"

namespace merlin {

// A lap: every corner passed in the outline's order, either way round, and then back within 1 m of the first position.
// A corner is passed within 2.5 m of the outline's corner, seen from above. Turning back takes corners back; a corner
// left out starts the count anew. 0 for a room without an outline.
int CountLaps(const Trajectory& truth, const Outline& outline);

}  // namespace merlin
