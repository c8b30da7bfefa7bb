// How one run of a sweep ended, as its folder tells.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/sweep/sweep_file.h"

namespace merlin {

struct SweepOutcome {
  bool passed = false;     // its verdict
  bool completed = false;  // it was not ended before its time, and has all laps that its task asks for
  std::string why{};       // it did not pass: what ended it, or the checks that failed; empty: it passed
  std::optional<double> ate_rmse_m{}, map_to_plan_p95_m{};
  std::optional<double> size_error_percent{};  // the worse of the two
  std::optional<double> sim_time_s{}, wall_time_s{}, distance_m{}, real_time_factor{};
  std::optional<int> laps{}, loops_closed{}, collisions{};
};

// Nothing: there is no result.json that can be read.
std::optional<SweepOutcome> ReadOutcome(const std::filesystem::path& folder, const Scenario& scenario);

// The last line of a log that is not empty; of a run without a result it says why.
std::string LastLine(const std::filesystem::path& log);

}  // namespace merlin
