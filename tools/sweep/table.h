// The table of a sweep: one row for each setting, with statistics of its runs and the limits that they keep or miss.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/sweep/outcome.h"
#include "tools/sweep/statistics.h"
#include "tools/sweep/sweep_file.h"

namespace merlin {

struct LimitOutcome {
  std::string name;               // a limit of SweepLimits
  std::optional<double> value{};  // none if not known, which misses the limit
  double limit = 0.0;
  bool kept = false;
};

struct SweepFigures {
  std::string name;
  int runs = 0, passed = 0, completed = 0;
  std::optional<Spread> ate_m{}, size_percent{}, walls_m{};  // of completed runs
  std::vector<LimitOutcome> limits{};
  std::vector<double> all_ate_m{};  // of completed runs, for the picture
};

struct SweepTable {
  std::string name;
  std::vector<SweepFigures> rows{};     // the rows that were run, then "all" for all runs together
  std::vector<std::string> failures{};  // "S3 seed 2: why", of runs that did not pass

  bool MissesALimit() const;
};

// outcomes: of sweep.runs, in their order.
SweepTable MakeTable(const std::string& name, const Sweep& sweep, std::span<const SweepOutcome> outcomes);

std::string ToMarkdown(const SweepTable& table);
std::string ToCsv(const SweepTable& table);                                         // one line per row
std::string RunsToCsv(const Sweep& sweep, std::span<const SweepOutcome> outcomes);  // one line per run
std::string ToPng(const SweepTable& table);                                         // ATE axis logarithmic

}  // namespace merlin
