#include "scenarios/judge/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"

namespace merlin {
namespace {

// All metrics as single numbers under the names that checks use.
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
    (*this)(fmt::format("{}.0", name), pair[0]);
    (*this)(fmt::format("{}.1", name), pair[1]);
    figures.end()[-3].values.push_back(figures.back().values.front());
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

std::string NearestCheck(const std::vector<Figure>& figures, const std::string& name) {
  std::vector<std::string> known;
  for (const Figure& figure : figures)
    for (const char* suffix : {"_max", "_min"}) known.push_back(figure.name + suffix);
  return NearestName(name, known);
}

Check EvaluateOne(const CheckLimit& limit, const Figure& figure, bool knows_truth) {
  const std::vector<std::optional<double>>& values = figure.values;
  Check check{.name = limit.name, .limit = limit.limit, .judged = CanKnow(figure.name, knows_truth)};
  if (!check.judged) return check;
  if (!std::all_of(values.begin(), values.end(), [](const auto& value) { return value.has_value(); })) return check;
  check.value =
      IsMax(limit) ? *std::max_element(values.begin(), values.end()) : *std::min_element(values.begin(), values.end());
  check.pass = IsMax(limit) ? *check.value <= limit.limit : *check.value >= limit.limit;
  return check;
}

}  // namespace

void RequireKnown(const CheckLimit& limit, const std::string& where) {
  const std::vector<Figure> figures = Figures({});
  if (!Find(figures, limit))
    throw InputError(where, fmt::format("unknown check '{}'", limit.name), "the name of a metric with _max or _min",
                     fmt::format("'{}'; the nearest is '{}'", limit.name, NearestCheck(figures, limit.name)));
  if (!std::isfinite(limit.limit))
    throw InputError(where, "limit of check " + limit.name, "a finite number", fmt::format("{}", limit.limit));
}

std::vector<Check> Evaluate(const std::vector<CheckLimit>& limits, const Metrics& metrics, bool knows_truth,
                            const std::string& where) {
  const std::vector<Figure> figures = Figures(metrics);
  std::vector<Check> checks;
  for (const CheckLimit& limit : limits) {
    RequireKnown(limit, where);
    checks.push_back(EvaluateOne(limit, *Find(figures, limit), knows_truth));
  }
  return checks;
}

std::string Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kInterrupted:
      return "interrupted";
    case Verdict::kNotJudged:
      return "not judged";
    default:
      return "fail";
  }
}

Verdict Judge(const std::vector<Check>& checks) {
  Verdict verdict = Verdict::kNotJudged;
  for (const Check& check : checks) {
    if (!check.judged) continue;
    if (!check.pass) return Verdict::kFail;
    verdict = Verdict::kPass;
  }
  return verdict;
}

}  // namespace merlin
