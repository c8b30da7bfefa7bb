#include "tools/sweep/outcome.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace merlin {
namespace {

using Json = nlohmann::json;

template <class Number>
std::optional<Number> Figure(const Json& metrics, const char* name) {
  const auto figure = metrics.find(name);
  return figure != metrics.end() && figure->is_number() ? std::optional(figure->get<Number>()) : std::nullopt;
}

std::optional<double> WorseOfTwo(const Json& metrics, const char* name) {
  const auto pair = metrics.find(name);
  if (pair == metrics.end() || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number())
    return std::nullopt;
  return std::max((*pair)[0].get<double>(), (*pair)[1].get<double>());
}

std::string FailedChecks(const Json& checks) {
  std::string failed;
  for (const Json& check : checks) {
    if (!check.at("pass").is_boolean() || check.at("pass").get<bool>()) continue;
    const Json& value = check.at("value");
    failed += fmt::format("{}{} is {}, limit {:g}", failed.empty() ? "" : "; ", check.at("name").get<std::string>(),
                          value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : "not known",
                          check.at("limit").get<double>());
  }
  return failed;
}

// Why a run failed. Distance and time at the end of a run show whether the car stood still.
std::string Why(const Json& result, const SweepOutcome& outcome, const Scenario& scenario) {
  if (result.contains("fault")) return result.at("fault").get<std::string>();
  std::string why = FailedChecks(result.at("checks"));
  if (!outcome.completed && outcome.sim_time_s.value_or(0.0) > scenario.duration_s - 1.0)
    why +=
        fmt::format("; its {:.0f} s were over after {:.1f} m", scenario.duration_s, outcome.distance_m.value_or(0.0));
  return why.empty() ? "verdict " + result.at("verdict").get<std::string>() : why;
}

SweepOutcome OutcomeOf(const Json& result, const Scenario& scenario) {
  const Json& metrics = result.at("metrics");
  SweepOutcome outcome{.passed = result.at("verdict") == "pass",
                       .ate_rmse_m = Figure<double>(metrics, "ate_rmse_m"),
                       .map_to_plan_p95_m = Figure<double>(metrics, "map_to_plan_p95_m"),
                       .size_error_percent = WorseOfTwo(metrics, "map_size_error_percent"),
                       .sim_time_s = Figure<double>(metrics, "sim_time_s"),
                       .wall_time_s = Figure<double>(metrics, "wall_time_s"),
                       .distance_m = Figure<double>(metrics, "distance_m"),
                       .real_time_factor = Figure<double>(metrics, "real_time_factor"),
                       .laps = Figure<int>(metrics, "laps"),
                       .loops_closed = Figure<int>(metrics, "loops_closed"),
                       .collisions = Figure<int>(metrics, "collisions")};
  outcome.completed = !result.contains("fault") && outcome.laps.value_or(0) >= scenario.task.laps;
  if (!outcome.passed) outcome.why = Why(result, outcome, scenario);
  return outcome;
}

}  // namespace

std::optional<SweepOutcome> ReadOutcome(const std::filesystem::path& folder, const Scenario& scenario) {
  try {
    std::ifstream in(folder / "result.json");
    return OutcomeOf(Json::parse(in), scenario);
  } catch (const nlohmann::json::exception&) {  // result.json is missing or incomplete
    return std::nullopt;
  }
}

std::string LastLine(const std::filesystem::path& log) {
  std::ifstream in(log);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace merlin
