// A sweep: one scenario in many settings, each on many seeds, and the limits that the results must keep. The file:
//
//   scenario: corridor_loop          # the base: a name in scenarios/, or a path (also beside this file)
//   lap_m: 87                        # optional: duration_s becomes 1.5 times the lap's length over pilot.speed_m_s
//   seeds: 1-5                       # or a list: 1,4,7-9
//   set: {sensors.color: null}       # optional: settings of all rows, as `merlin run --set`
//   limits: {pass_share_min: 0.8}    # optional: of every row; a row's own limit goes before
//   all: {pass_share_min: 0.95}      # optional: of all runs together
//   rows:
//     - {name: S3, set: {sensors.depth.camera: pmd_s3}}
//     - {name: wet, scenario: corridor_wet, limits: {ate_median_m_max: 0.1}}
//
// A row may have a scenario and seeds of its own, and compared_with, the name of another row, for ate_median_ratio_max.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "robot/base/config.h"
#include "scenarios/config/scenario.h"

namespace merlin {

// Path errors, sizes and walls are those of completed runs: not ended before their time, with all laps that the task asks
// for.
struct SweepLimits {
  std::optional<double> pass_share_min{};    // [0, 1] of the runs that pass the checks of their scenario
  std::optional<double> ate_median_m_max{};  // ate_rmse_m
  std::optional<double> ate_worst_m_max{};
  std::optional<double> ate_median_ratio_max{};    // over that of the row compared_with
  std::optional<double> size_worst_percent_max{};  // the worse of the two of map_size_error_percent
  std::optional<double> walls_worst_m_max{};       // map_to_plan_p95_m
};

template <class Visitor>
void Visit(Visitor& v, SweepLimits& c) {
  v("pass_share_min", c.pass_share_min, {0.0, 1.0});
  v("ate_median_m_max", c.ate_median_m_max, {0.0, 1e6});
  v("ate_worst_m_max", c.ate_worst_m_max, {0.0, 1e6});
  v("ate_median_ratio_max", c.ate_median_ratio_max, {0.0, 1e6});
  v("size_worst_percent_max", c.size_worst_percent_max, {0.0, 1e6});
  v("walls_worst_m_max", c.walls_worst_m_max, {0.0, 1e6});
}

// "a.b=c", and where the file says so.
struct Assignment {
  std::string text, where;
};

struct SweepRow {
  std::string name;               // letters, digits and _ . + -: folders are called so
  std::string scenario;           // default: the sweep's
  std::string seeds;              // default: the sweep's
  std::vector<Assignment> set{};  // the sweep's first, then its own
  SweepLimits limits;             // with the sweep's, where the row has none
  std::string compared_with;
  std::string where;  // FILE:LINE
};

// One run of a sweep, resolved.
struct SweepRun {
  std::size_t row = 0;
  std::uint64_t seed = 1;
  Scenario scenario;
  std::vector<std::string> sets{};  // that make it of the row's scenario
};

struct Sweep {
  std::string scenario;
  double lap_m = 0.0;
  std::string seeds = "1";
  std::vector<Assignment> set{};
  SweepLimits limits, all;
  std::vector<SweepRow> rows{};
  std::vector<SweepRun> runs{};  // row by row; not in the file
};

// What is taken of a sweep.
struct SweepChoice {
  std::string seeds{};              // instead of the file's; empty: the file's
  std::vector<std::string> rows{};  // names; empty: all
};

// name: of a file in scenarios/sweeps/ without its ending, or a path. Throws InputError with every fault of the file, a
// line each: unknown keys, and settings that no scenario, camera or room of that name has or that they do not allow.
Sweep ReadSweep(const std::string& name, const SweepChoice& choice);

// "1-5" or "1,4,7-9" as numbers, in that order. Throws InputError, which names where.
std::vector<std::uint64_t> SeedsOf(const std::string& text, const std::string& where);

}  // namespace merlin
