// The outcome of a run, as result.json and junit.xml.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/judge/checks.h"
#include "scenarios/judge/metrics.h"

namespace merlin {

// SHA-256 in hexadecimal digits; none if the run has no such data.
struct Hashes {
  std::optional<std::string> state, depth, color, trajectory, map;
};

struct RunResult {
  std::string scenario{};
  std::uint64_t seed = 0;
  Verdict verdict = Verdict::kFail;
  // What ended the run early, other than an interruption: a lost device, an empty battery, a car that makes no
  // progress. Empty if nothing did.
  std::string fault{};
  std::vector<Check> checks{};
  Metrics metrics{};
  Hashes hashes{};
  std::vector<std::pair<std::string, std::string>> versions{};  // of the program and what it links: name, version
};

// The text of result.json. "pass" is null for a check that was not judged. Invalid UTF-8 becomes U+FFFD.
std::string ToJson(const RunResult& result);

// The text of junit.xml: one test case per check, and one named "run", which is an error if the run was interrupted or
// ended by a fault. A check that was not judged is skipped. Characters that XML does not allow are replaced.
std::string ToJUnit(const RunResult& result);

}  // namespace merlin
