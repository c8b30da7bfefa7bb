// Compares the map with the true surfaces: how much of the plan it covers, and how far its walls are from the true
// ones.
#pragma once

#include <optional>
#include <span>

#include "robot/types/ground_truth.h"
#include "robot/types/se3.h"
#include "scenarios/judge/map_point.h"
#include "scenarios/judge/outline.h"

namespace merlin {

// Share of the plan's visible wall length that the map covers, [0, 100]. The outline is sampled every 5 cm, 1 m above
// the floor (z = 0). A sample is visible if a ray towards it, from 0.35 m above a true position (one every 0.25 m of
// path) at most 7 m away, ends within 5 cm of it. It is covered if a map point 0.1 to 2.0 m above the floor lies within
// 0.10 m of it, seen from above. None if no sample is visible.
std::optional<double> CoveragePercent(std::span<const MapPoint> map, const Pose& T_world_map, const Outline& outline,
                                      const Trajectory& truth, const TrueRange& true_range);

// 95th percentile (nearest rank) of the distances from the map's wall points to the true surfaces. Wall points are 0.3
// to 2.0 m above the floor and have a normal (from neighbours within 0.15 m) within 20 degrees of level; of more than
// 20,000 only every n-th in the map's order is used. The distance is the shortest along the normal and the three world
// axes, in both directions of each, which is exact in front of and behind planes. None if there are no wall points or
// no ray hits.
std::optional<double> MapToPlanP95_m(std::span<const MapPoint> map, const Pose& T_world_map,
                                     const TrueRange& true_range);

}  // namespace merlin
