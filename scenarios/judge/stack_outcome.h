// What the stack found out in a run, as plain data: the judge compares it with the truth and writes it to files.
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
  Trajectory estimate;        // T_map_base at every depth frame, as corrected at the end
  Trajectory online;          // the same frames, as the car drove by them
  std::vector<MapPoint> map;  // points seen at least as often as the scenario asks for
  GridMap grid;               // one unknown cell where nothing was seen: still a map
  double path_m = 0.0;        // by the odometry
  int loops_closed = 0;
  std::vector<double> stack_ms{};                          // one a depth frame: filter to decision
  std::string map_slam{};                                  // the bytes of the file (slam/saved_map.h)
  std::optional<double> place_found_s{}, place_found_m{};  // in the map of an earlier run
};

// points_min: see SlamConfig::map_points_min.
StackOutcome OutcomeOf(const Slam& slam, int points_min, const std::vector<double>& stack_ms);

}  // namespace merlin
