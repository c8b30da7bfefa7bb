// The metrics of a run.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace merlin {

// Milliseconds from a depth frame's arrival to the drive command.
struct StackTimes {
  std::optional<double> p50, p99, max;
};

// In the order of result.json. A metric that is not known is empty here and null in JSON; one that is not finite counts
// as empty.
struct Metrics {
  std::optional<double> sim_time_s, wall_time_s, setup_s, real_time_factor, distance_m;
  std::optional<std::int64_t> laps, collisions, loops_closed;  // loops_closed: loop closures that corrected the map
  std::optional<double> ate_rmse_m, ate_online_rmse_m, rpe_translation_percent, rpe_rotation_deg_per_m;
  std::array<std::optional<double>, 2> map_size_m, map_size_error_percent;
  std::optional<double> map_to_plan_p95_m, coverage_percent;
  std::optional<std::int64_t> depth_frames, color_frames, frames_dropped;
  StackTimes stack_ms;
  std::optional<double> peak_rss_mb, stack_rss_mb;
  // Only for scenarios with an obstacle or actor; left out of result.json if empty.
  std::optional<double> obstacle_gap_m, obstacle_stop_s;
  // Of scenarios that start in a map only, and left out likewise: when the car knew its place in it, since the first frame.
  std::optional<double> place_found_s, place_found_m;
};

// Calls visit(name, metric) for each metric in the order of result.json. This is the only list of names.
template <class Visitor>
void VisitMetrics(const Metrics& m, Visitor visit) {
  visit("sim_time_s", m.sim_time_s);
  visit("wall_time_s", m.wall_time_s);
  visit("setup_s", m.setup_s);
  visit("real_time_factor", m.real_time_factor);
  visit("distance_m", m.distance_m);
  visit("laps", m.laps);
  visit("collisions", m.collisions);
  visit("loops_closed", m.loops_closed);
  visit("ate_rmse_m", m.ate_rmse_m);
  visit("ate_online_rmse_m", m.ate_online_rmse_m);
  visit("rpe_translation_percent", m.rpe_translation_percent);
  visit("rpe_rotation_deg_per_m", m.rpe_rotation_deg_per_m);
  visit("map_size_m", m.map_size_m);
  visit("map_size_error_percent", m.map_size_error_percent);
  visit("map_to_plan_p95_m", m.map_to_plan_p95_m);
  visit("coverage_percent", m.coverage_percent);
  visit("depth_frames", m.depth_frames);
  visit("color_frames", m.color_frames);
  visit("frames_dropped", m.frames_dropped);
  visit("stack_ms", m.stack_ms);
  visit("peak_rss_mb", m.peak_rss_mb);
  visit("stack_rss_mb", m.stack_rss_mb);
  visit("obstacle_gap_m", m.obstacle_gap_m);
  visit("obstacle_stop_s", m.obstacle_stop_s);
  visit("place_found_s", m.place_found_s);
  visit("place_found_m", m.place_found_m);
}

// Whether a run can know a metric at all. Without the truth it cannot know metrics that compare with it (the distance
// then comes from the odometry). With the truth it cannot know the memory of the stack alone, because the simulation
// runs in the same process. name: as in a check, for example "map_size_m.0" for the first value of map_size_m.
inline bool CanKnow(std::string_view name, bool knows_truth) {
  if (name == "stack_rss_mb") return !knows_truth;
  if (knows_truth) return true;
  for (const std::string_view truth : {"laps", "collisions", "coverage_percent"})
    if (name == truth) return false;
  for (const std::string_view truth : {"ate_", "rpe_", "map_size_", "map_to_plan_", "obstacle_"})
    if (name.starts_with(truth)) return false;
  return true;
}

}  // namespace merlin
