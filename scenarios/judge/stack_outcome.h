// The results of the stack in a run, as plain data. The judge compares them with the truth and writes them to files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/types/trajectory.h"
#include "scenarios/judge/map_point.h"
#include "scenarios/judge/writers.h"
#include "slam/slam.h"

namespace merlin {

struct StackOutcome {
  Trajectory estimate;        // T_map_base at every depth frame, after all corrections
  Trajectory online;          // the same frames with the poses that were known at the time
  std::vector<MapPoint> map;  // points observed at least points_min times
  GridMap grid;               // a single unknown cell if nothing was observed
  double path_m = 0.0;        // path length from odometry
  int loops_closed = 0;
  std::vector<double> stack_ms{};  // per depth frame: time from filter to decision
  std::string map_slam{};          // the bytes of map.slam (slam/saved_map.h)
  std::optional<double> place_found_s{},
      place_found_m{};  // time and distance until the place in a loaded map was found
};

// points_min: see SlamConfig::map_points_min.
StackOutcome OutcomeOf(const Slam& slam, int points_min, const std::vector<double>& stack_ms);

}  // namespace merlin
