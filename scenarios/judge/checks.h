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
  bool judged = true;  // false: this run cannot know the metric, see CanKnow
  bool pass = false;   // false also where it is not judged
};

// Throws InputError for a name that is no metric's with _max or _min (names the nearest), or a limit that is not
// finite. where: the file, and the line if known.
void RequireKnown(const CheckLimit& limit, const std::string& where);

// Each limit judged, in the order given: value <= limit, value >= limit; both values of a metric of two. A metric that is
// not known fails; one that this run cannot know (CanKnow) is not judged. Throws as RequireKnown.
std::vector<Check> Evaluate(const std::vector<CheckLimit>& limits, const Metrics& metrics, bool knows_truth,
                            const std::string& where);

enum class Verdict { kPass, kFail, kInterrupted, kNotJudged };

// "pass", "fail", "interrupted", "not judged"
std::string Name(Verdict verdict);

// kFail if a check failed; kPass if one passed and none failed; kNotJudged if nothing was judged.
Verdict Judge(const std::vector<Check>& checks);

}  // namespace merlin
