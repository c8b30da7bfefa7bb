// The checks of a scenario, and the verdict that follows from them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/judge/metrics.h"

namespace merlin {

// One check of a scenario. name: the name of a metric with "_max" or "_min" appended. A nested metric is
// "stack_ms.p99", the first of two values "map_size_m.0".
struct CheckLimit {
  std::string name;
  double limit = 0.0;
};

struct Check {
  std::string name{};
  std::optional<double> value{};  // of two values the one nearer to failing; none if one of them is not known
  double limit = 0.0;
  bool judged = true;  // false if this run cannot know the metric, see CanKnow
  bool pass = false;   // also false if not judged
};

// Throws InputError if the name is not that of a metric with _max or _min (and suggests the nearest), or if the limit
// is not finite. where: the file, and the line if known.
void RequireKnown(const CheckLimit& limit, const std::string& where);

// Judges each limit in the order given: value <= limit for _max, value >= limit for _min, and for both values of a
// metric with two. A metric without a value fails, unless this run cannot know it (CanKnow): then it is not judged.
// Throws like RequireKnown.
std::vector<Check> Evaluate(const std::vector<CheckLimit>& limits, const Metrics& metrics, bool knows_truth,
                            const std::string& where);

enum class Verdict { kPass, kFail, kInterrupted, kNotJudged };

// "pass", "fail", "interrupted", "not judged"
std::string Name(Verdict verdict);

// kFail if a check failed; kPass if one passed and none failed; kNotJudged if nothing was judged.
Verdict Judge(const std::vector<Check>& checks);

}  // namespace merlin
