#include "scenarios/judge/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "robot/types/error.h"

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;

// The one list of names: visit(name, figure) for each, in result.json's order. Where empty, the optional ones are left
// out.
template <class Visitor>
void VisitMetrics(const Metrics& m, Visitor visit) {
  visit("sim_time_s", m.sim_time_s);
  visit("wall_time_s", m.wall_time_s);
  visit("setup_s", m.setup_s);
  visit("real_time_factor", m.real_time_factor);
  visit("distance_m", m.distance_m);
  visit("laps", m.laps);
  visit("collisions", m.collisions);
  visit("ate_rmse_m", m.ate_rmse_m);
  visit("ate_online_rmse_m", m.ate_online_rmse_m);
  visit("rpe_translation_percent", m.rpe_translation_percent);
  visit("rpe_rotation_deg_per_m", m.rpe_rotation_deg_per_m);
  visit("map_size_m", m.map_size_m);
  visit("map_size_error_percent", m.map_size_error_percent);
  visit("map_to_plan_p95_m", m.map_to_plan_p95_m);
  visit("coverage_percent", m.coverage_percent);
  visit("depth_frames", m.depth_frames);
  visit("color_frames", m.color_frames);
  visit("frames_dropped", m.frames_dropped);
  visit("stack_ms", m.stack_ms);
  visit("peak_rss_mb", m.peak_rss_mb);
  visit("stack_rss_mb", m.stack_rss_mb);
  visit("obstacle_gap_m", m.obstacle_gap_m);
  visit("obstacle_stop_s", m.obstacle_stop_s);
}

Json ToJsonValue(const std::optional<std::int64_t>& count) { return count ? Json(*count) : Json(); }
Json ToJsonValue(const std::optional<double>& value) { return value && std::isfinite(*value) ? Json(*value) : Json(); }
Json ToJsonValue(const std::array<std::optional<double>, 2>& pair) {
  return Json::array({ToJsonValue(pair[0]), ToJsonValue(pair[1])});
}
Json ToJsonValue(const StackTimes& times) {
  return {{"p50", ToJsonValue(times.p50)}, {"p99", ToJsonValue(times.p99)}, {"max", ToJsonValue(times.max)}};
}
Json ToJsonValue(const std::optional<std::string>& hash) { return hash ? Json(*hash) : Json(); }

// Every figure as numbers under the name a check calls it by.
struct Figure {
  std::string name;
  std::vector<std::optional<double>> values;
};

struct Collector {
  std::vector<Figure>& figures;

  void operator()(std::string_view name, const std::optional<double>& value) {
    figures.push_back({std::string(name), {value && std::isfinite(*value) ? value : std::nullopt}});
  }
  void operator()(std::string_view name, const std::optional<std::int64_t>& count) {
    (*this)(name, count ? std::optional(static_cast<double>(*count)) : std::nullopt);
  }
  void operator()(std::string_view name, const std::array<std::optional<double>, 2>& pair) {
    (*this)(name, pair[0]);
    (*this)(name, pair[1]);
    figures.end()[-2].values.push_back(figures.back().values.front());
    figures.pop_back();
  }
  void operator()(std::string_view name, const StackTimes& times) {
    (*this)(fmt::format("{}.p50", name), times.p50);
    (*this)(fmt::format("{}.p99", name), times.p99);
    (*this)(fmt::format("{}.max", name), times.max);
  }
};

std::vector<Figure> Figures(const Metrics& metrics) {
  std::vector<Figure> figures;
  VisitMetrics(metrics, Collector{figures});
  return figures;
}

bool IsMax(const CheckLimit& limit) { return limit.name.ends_with("_max"); }

const Figure* Find(const std::vector<Figure>& figures, const CheckLimit& limit) {
  const auto figure = std::find_if(figures.begin(), figures.end(), [&limit](const Figure& candidate) {
    return limit.name == candidate.name + "_max" || limit.name == candidate.name + "_min";
  });
  return figure == figures.end() ? nullptr : &*figure;
}

// Insertions, deletions and replacements that turn a into b (Levenshtein 1966).
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string NearestCheck(const std::vector<Figure>& figures, const std::string& name) {
  std::string nearest;
  std::size_t nearest_edits = std::numeric_limits<std::size_t>::max();
  for (const Figure& figure : figures) {
    for (const char* suffix : {"_max", "_min"}) {
      const std::size_t edits = EditDistance(name, figure.name + suffix);
      if (edits >= nearest_edits) continue;
      nearest_edits = edits;
      nearest = figure.name + suffix;
    }
  }
  return nearest;
}

Check EvaluateOne(const CheckLimit& limit, const std::vector<std::optional<double>>& values) {
  Check check{.name = limit.name, .value = std::nullopt, .limit = limit.limit, .pass = false};
  if (!std::all_of(values.begin(), values.end(), [](const auto& value) { return value.has_value(); })) return check;
  check.value =
      IsMax(limit) ? *std::max_element(values.begin(), values.end()) : *std::min_element(values.begin(), values.end());
  check.pass = IsMax(limit) ? *check.value <= limit.limit : *check.value >= limit.limit;
  return check;
}

// Text as XML may hold it: markup escaped, control characters and bytes outside ASCII replaced.
std::string Xml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += c >= 32 && c < 127 ? c : '?';
    }
  }
  return escaped;
}

std::string TestCase(const RunResult& result, const Check& check) {
  const std::string open =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\"", Xml(result.scenario), Xml(check.name));
  if (check.pass) return open + "/>\n";
  const std::string value = check.value ? fmt::format("{}", *check.value) : "not known";
  return open + fmt::format(">\n      <failure message=\"{}: value {}, limit {}\"/>\n    </testcase>\n",
                            Xml(check.name), value, check.limit);
}

}  // namespace

void RequireKnown(const CheckLimit& limit, const std::string& where) {
  const std::vector<Figure> figures = Figures({});
  if (!Find(figures, limit))
    throw InputError(where, fmt::format("unknown check '{}'", limit.name), "a metric's name and _max or _min",
                     fmt::format("'{}'; the nearest is '{}'", limit.name, NearestCheck(figures, limit.name)));
  if (!std::isfinite(limit.limit))
    throw InputError(where, "limit of check " + limit.name, "a finite number", fmt::format("{}", limit.limit));
}

std::vector<Check> Evaluate(const std::vector<CheckLimit>& limits, const Metrics& metrics, const std::string& where) {
  const std::vector<Figure> figures = Figures(metrics);
  std::vector<Check> checks;
  for (const CheckLimit& limit : limits) {
    RequireKnown(limit, where);
    checks.push_back(EvaluateOne(limit, Find(figures, limit)->values));
  }
  return checks;
}

std::string Name(Verdict verdict) {
  if (verdict == Verdict::kInterrupted) return "interrupted";
  return verdict == Verdict::kPass ? "pass" : "fail";
}

Verdict Judge(const std::vector<Check>& checks) {
  const bool pass = std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.pass; });
  return pass ? Verdict::kPass : Verdict::kFail;
}

std::string ToJson(const RunResult& result) {
  Json checks = Json::array();
  for (const Check& check : result.checks)
    checks.push_back(
        {{"name", check.name}, {"value", ToJsonValue(check.value)}, {"limit", check.limit}, {"pass", check.pass}});
  Json metrics = Json::object();
  VisitMetrics(result.metrics, [&metrics](std::string_view name, const auto& figure) {
    Json value = ToJsonValue(figure);
    if (value.is_null() && name.starts_with("obstacle_")) return;
    metrics[std::string(name)] = std::move(value);
  });
  Json versions = Json::object();
  for (const auto& [name, version] : result.versions) versions[name] = version;

  Json json;
  json["scenario"] = result.scenario;
  json["seed"] = result.seed;
  json["verdict"] = Name(result.verdict);
  json["checks"] = std::move(checks);
  json["metrics"] = std::move(metrics);
  json["hashes"]["state"] = ToJsonValue(result.hashes.state);
  json["hashes"]["depth"] = ToJsonValue(result.hashes.depth);
  json["hashes"]["color"] = ToJsonValue(result.hashes.color);
  json["hashes"]["trajectory"] = ToJsonValue(result.hashes.trajectory);
  json["hashes"]["map"] = ToJsonValue(result.hashes.map);
  json["versions"] = std::move(versions);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string ToJUnit(const RunResult& result) {
  const auto failures =
      std::count_if(result.checks.begin(), result.checks.end(), [](const Check& check) { return !check.pass; });
  const bool interrupted = result.verdict == Verdict::kInterrupted;
  const double time_s = result.metrics.wall_time_s.value_or(0.0);
  const std::string counts = fmt::format(
      "name=\"{} seed {}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", Xml(result.scenario),
      result.seed, result.checks.size() + 1, failures, interrupted ? 1 : 0, std::isfinite(time_s) ? time_s : 0.0);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite " + counts + ">\n";
  xml += fmt::format("    <testcase classname=\"{}\" name=\"run\" time=\"0\"", Xml(result.scenario));
  xml += interrupted ? ">\n      <error message=\"interrupted\"/>\n    </testcase>\n" : "/>\n";
  for (const Check& check : result.checks) xml += TestCase(result, check);
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace merlin
