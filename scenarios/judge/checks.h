// The checks a scenario asks for, and the verdict they give.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/judge/metrics.h"

namespace merlin {

// A line of a scenario's checks: a metric's name (of a nested one "stack_ms.p99", of the first of two values
// "map_size_m.0") and "_max" or "_min".
struct CheckLimit {
  std::string name;
  double limit = 0.0;
};

struct Check {
  std::string name{};
  std::optional<double> value{};  // of a metric of two values the one nearer to failing; empty if one is not known
  double limit = 0.0;
  bool pass = false;
};

// Throws InputError for a name that is no metric's with _max or _min (names the nearest), or a limit that is not
// finite. where: the file, and the line if known.
void RequireKnown(const CheckLimit& limit, const std::string& where);

// Each limit judged, in the order given: value <= limit, value >= limit; both values of a metric of two. A metric that
// is not known fails. Throws as RequireKnown.
std::vector<Check> Evaluate(const std::vector<CheckLimit>& limits, const Metrics& metrics, const std::string& where);

enum class Verdict { kPass, kFail, kInterrupted };

// "pass", "fail", "interrupted"
std::string Name(Verdict verdict);

// kPass if every check passed; no checks, nothing failed.
Verdict Judge(const std::vector<Check>& checks);

}  // namespace merlin
