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

// SHA-256 as hexadecimal digits; empty where a run had none of it.
struct Hashes {
  std::optional<std::string> state, depth, color, trajectory, map;
};

struct RunResult {
  std::string scenario{};
  std::uint64_t seed = 0;
  Verdict verdict = Verdict::kFail;
  // What ended the run before its time, but not an interruption: a lost device, an empty battery, a car that does not get
  // on; else empty.
  std::string fault{};
  std::vector<Check> checks{};
  Metrics metrics{};
  Hashes hashes{};
  std::vector<std::pair<std::string, std::string>> versions{};  // of the program and what it links: name, version
};

// The text of result.json; "pass" of a check that was not judged is null. Bytes that are no UTF-8 become U+FFFD.
std::string ToJson(const RunResult& result);

// The text of junit.xml: one test case a check, and one named "run", in error where the run was
// interrupted or ended by a fault; a check that was not judged is skipped. UTF-8 stays as it is; what XML may not hold is replaced, so that it is well formed.
std::string ToJUnit(const RunResult& result);

}  // namespace merlin
