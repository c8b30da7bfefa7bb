// A sweep: one scenario in many settings, each on many seeds, and the limits that the results must keep. The file:
//
//   scenario: corridor_loop          # the base: a name in scenarios/, or a path (also beside this file)
//   lap_m: 87                        # optional: duration_s becomes 1.5 times the lap's length over pilot.speed_m_s
//   seeds: 1-5                       # or a list: 1,4,7-9
//   set: {sensors.color: null}       # optional: settings for all rows, as in `merlin run --set`
//   limits: {pass_share_min: 0.8}    # optional: for every row; a row's own limit takes precedence
//   all: {pass_share_min: 0.95}      # optional: for all runs together
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

// Path errors, sizes and walls count only in completed runs: those that did not end early and drove all laps of the
// task.
struct SweepLimits {
  std::optional<double> pass_share_min{};    // share of runs that pass the checks of their scenario, [0, 1]
  std::optional<double> ate_median_m_max{};  // ate_rmse_m
  std::optional<double> ate_worst_m_max{};
  std::optional<double> ate_median_ratio_max{};    // relative to that of the row compared_with
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

// A setting "a.b=c", and its place in the file.
struct Assignment {
  std::string text, where;
};

struct SweepRow {
  std::string name;               // letters, digits and _ . + -; also the name of its folder
  std::string scenario;           // default: the sweep's
  std::string seeds;              // default: the sweep's
  std::vector<Assignment> set{};  // those of the sweep, then its own
  SweepLimits limits;             // its own, and those of the sweep for which it has none
  std::string compared_with;
  std::string where;  // FILE:LINE
};

// One run of a sweep, resolved.
struct SweepRun {
  std::size_t row = 0;
  std::uint64_t seed = 1;
  Scenario scenario;
  std::vector<std::string> sets{};  // all settings that are applied to the row's scenario
};

struct Sweep {
  std::string scenario;
  double lap_m = 0.0;
  std::string seeds = "1";
  std::vector<Assignment> set{};
  SweepLimits limits, all;
  std::vector<SweepRow> rows{};
  std::vector<SweepRun> runs{};  // row by row; not a key of the file
};

// The part of a sweep to run.
struct SweepChoice {
  std::string seeds{};              // instead of the file's; empty: the file's
  std::vector<std::string> rows{};  // names; empty: all
};

// name: a file in scenarios/sweeps/ without its extension, or a path. Throws InputError with every fault of the file,
// one per line: unknown keys, and settings that do not exist in the scenario, camera or room, or that they do not
// allow.
Sweep ReadSweep(const std::string& name, const SweepChoice& choice);

// The numbers in "1-5" or "1,4,7-9", in that order. Throws InputError that begins with where.
std::vector<std::uint64_t> SeedsOf(const std::string& text, const std::string& where);

}  // namespace merlin
