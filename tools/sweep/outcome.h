// The outcome of one run of a sweep, read from its folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/sweep/sweep_file.h"

namespace merlin {

struct SweepOutcome {
  bool passed = false;     // the verdict is pass
  bool completed = false;  // it did not end early, and drove all laps of the task
  std::string why{};       // why it did not pass: what ended it, or the checks that failed; empty if it passed
  std::optional<double> ate_rmse_m{}, map_to_plan_p95_m{};
  std::optional<double> size_error_percent{};  // the larger of the two
  std::optional<double> sim_time_s{}, wall_time_s{}, distance_m{}, real_time_factor{};
  std::optional<int> laps{}, loops_closed{}, collisions{};
};

// None if there is no readable result.json.
std::optional<SweepOutcome> ReadOutcome(const std::filesystem::path& folder, const Scenario& scenario);

// The last line of a log that is not empty. For a run without a result it says why.
std::string LastLine(const std::filesystem::path& log);

}  // namespace merlin
