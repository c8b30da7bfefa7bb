// The outcome of a run: its figures, the checks made of them, the verdict; as result.json and junit.xml.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace merlin {

// Milliseconds from a depth frame's arrival to the drive command.
struct StackTimes {
  std::optional<double> p50, p99, max;
};

// Figures of a run, in result.json's order. Empty: not known, null in JSON; a number that is not finite counts as
// empty.
struct Metrics {
  std::optional<double> sim_time_s, wall_time_s, setup_s, real_time_factor, distance_m;
  std::optional<std::int64_t> laps, collisions;
  std::optional<double> ate_rmse_m, ate_online_rmse_m, rpe_translation_percent, rpe_rotation_deg_per_m;
  std::array<std::optional<double>, 2> map_size_m, map_size_error_percent;
  std::optional<double> map_to_plan_p95_m, coverage_percent;
  std::optional<std::int64_t> depth_frames, color_frames, frames_dropped;
  StackTimes stack_ms;
  std::optional<double> peak_rss_mb, stack_rss_mb;
  // Of scenarios with an obstacle only; left out of result.json where empty.
  std::optional<double> obstacle_gap_m, obstacle_stop_s;
};

// A line of a scenario's checks: a metric's name (of a nested one "stack_ms.p99") and "_max" or "_min".
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

// SHA-256 as hexadecimal digits; empty where a run had none of it.
struct Hashes {
  std::optional<std::string> state, depth, color, trajectory, map;
};

struct RunResult {
  std::string scenario{};
  std::uint64_t seed = 0;
  Verdict verdict = Verdict::kFail;
  std::vector<Check> checks{};
  Metrics metrics{};
  Hashes hashes{};
  std::vector<std::pair<std::string, std::string>> versions{};  // of the program and what it links: name, version
};

// The text of result.json. Bytes that are no UTF-8 become U+FFFD.
std::string ToJson(const RunResult& result);

// The text of junit.xml: one test case a check, and one named "run", in error where the run was interrupted.
std::string ToJUnit(const RunResult& result);

}  // namespace merlin
