// The map against the true surfaces: how much of the plan it shows, and how far its walls lie from the true ones.
#pragma once

#include <optional>
#include <span>

#include "robot/types/ground_truth.h"
#include "robot/types/se3.h"
#include "scenarios/judge/map_point.h"
#include "scenarios/judge/outline.h"

namespace merlin {

// Share of the plan's visible wall length that the map shows, [0, 100]. The outline is sampled every 5 cm, 1 m above
// the floor (z = 0). A sample is visible if from 0.35 m above some true position (one each 0.25 m of path), at most 7 m
// away, the ray towards it ends within 5 cm of it; shown if a map point 0.1 to 2.0 m above the floor lies within 0.10 m
// of it as seen from above. Nothing if no sample is visible.
std::optional<double> CoveragePercent(std::span<const MapPoint> map, const Pose& T_world_map, const Outline& outline,
                                      const Trajectory& truth, const TrueRange& true_range);

// 95th percentile (nearest rank) of the distances of the map's wall points to the true surfaces. Wall points: 0.3
// to 2.0 m above the floor, normal (from neighbours within 0.15 m) within 20 degrees of level; of more than 20,000
// every n-th in the map's order. The distance is the shortest along both ways of the normal and of the three world
// axes, which is exact before and behind planes. Nothing if there are no wall points, or no surface is met.
std::optional<double> MapToPlanP95_m(std::span<const MapPoint> map, const Pose& T_world_map,
                                     const TrueRange& true_range);

}  // namespace merlin
