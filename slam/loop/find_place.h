// Finds where in a map the car is, without any guess: for a car that starts in a map it loaded, and for one whose
// estimate has drifted. The floor plan gives candidates (slam/loop/floor_plan.h), and registration against the key
// frames near each verifies it (slam/loop/find_loop.h). The place is known where exactly one of them fits and
// determines the position. Where others elsewhere fit as well, such as along a bare corridor, it is not known.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "slam/keyframe.h"
#include "slam/loop/find_loop.h"
#include "slam/loop/floor_plan.h"
#include "slam/map/occupancy_grid.h"

namespace merlin {

struct PlaceFound {
  std::optional<Loop> place;  // where the car is, if that is known
  double rms_m = 0.0;         // how well the points fit there: inliers' distances from the former map...
  double score = 0.0;         // ...and the share of walls on the floor plan (PlanMatch)
  int fitting = 0;            // poses that fit alike; 0: a foreign place; 2 and more: they cannot be told apart
};

class PlaceFinder {
 public:
  // heights: what is as high as an obstacle. Takes a few tens of milliseconds for a map of 100 m. Make a new one when the
  // key frames have moved.
  PlaceFinder(std::span<const Keyframe> keyframes, const LoopConfig& config, const OccupancyConfig& heights);

  // points_base: what was seen over the last metres, in the present frame; more of it makes the place clearer.
  // keyframes: those that the finder was made from. region and heading: nothing: anywhere. Takes some 10 ms per candidate.
  PlaceFound Find(std::span<const Keyframe> keyframes, std::span<const Point> points_base,
                  const std::optional<PlanRegion>& region = {}, const std::optional<PlanHeading>& heading = {}) const;

 private:
  double FreeShare(std::span<const Point> points_base, const Pose& T_map_base) const;

  LoopConfig config_;
  OccupancyConfig heights_;
  FloorPlan plan_;
};

}  // namespace merlin
