#include "scenarios/judge/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "robot/base/utf8.h"

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;

Json ToJsonValue(const std::optional<std::int64_t>& count) { return count ? Json(*count) : Json(); }
Json ToJsonValue(const std::optional<double>& value) { return value && std::isfinite(*value) ? Json(*value) : Json(); }
Json ToJsonValue(const std::array<std::optional<double>, 2>& pair) {
  return Json::array({ToJsonValue(pair[0]), ToJsonValue(pair[1])});
}
Json ToJsonValue(const StackTimes& times) {
  return {{"p50", ToJsonValue(times.p50)}, {"p99", ToJsonValue(times.p99)}, {"max", ToJsonValue(times.max)}};
}
Json ToJsonValue(const std::optional<std::string>& hash) { return hash ? Json(*hash) : Json(); }

// One character as part of an XML 1.0 attribute value (section 2.2, Char). Markup and white space are escaped, because
// a parser turns bare line ends into blanks. Control characters and noncharacters, which XML does not allow, become
// '?'.
std::string XmlCharacter(char32_t code, std::string_view bytes) {
  switch (code) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\t':
    case '\n':
    case '\r':
      return fmt::format("&#{};", static_cast<int>(code));
    default:
      return code < 0x20 || code == 0xFFFE || code == 0xFFFF ? "?" : std::string(bytes);
  }
}

// Invalid UTF-8 becomes U+FFFD, as in result.json.
std::string Xml(std::string_view text) {
  std::string escaped;
  while (!text.empty()) {
    const Utf8Character first = FirstCharacter(text);
    escaped += first.valid ? XmlCharacter(first.code, text.substr(0, first.bytes)) : "\uFFFD";
    text.remove_prefix(first.bytes);
  }
  return escaped;
}

std::string TestCase(const RunResult& result, const Check& check) {
  const std::string open =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\"", Xml(result.scenario), Xml(check.name));
  if (!check.judged)
    return open + ">\n      <skipped message=\"not judged: this run cannot know it\"/>\n    </testcase>\n";
  if (check.pass) return open + "/>\n";
  const std::string value = check.value ? fmt::format("{}", *check.value) : "not known";
  return open + fmt::format(">\n      <failure message=\"{}: value {}, limit {}\"/>\n    </testcase>\n",
                            Xml(check.name), value, check.limit);
}

}  // namespace

std::string ToJson(const RunResult& result) {
  Json checks = Json::array();
  for (const Check& check : result.checks)
    checks.push_back({{"name", check.name},
                      {"value", ToJsonValue(check.value)},
                      {"limit", check.limit},
                      {"pass", check.judged ? Json(check.pass) : Json()}});
  Json metrics = Json::object();
  VisitMetrics(result.metrics, [&metrics](std::string_view name, const auto& figure) {
    Json value = ToJsonValue(figure);
    if (value.is_null() && (name.starts_with("obstacle_") || name.starts_with("place_"))) return;
    metrics[std::string(name)] = std::move(value);
  });
  Json versions = Json::object();
  for (const auto& [name, version] : result.versions) versions[name] = version;

  Json json;
  json["scenario"] = result.scenario;
  json["seed"] = result.seed;
  json["verdict"] = Name(result.verdict);
  if (!result.fault.empty()) json["fault"] = result.fault;
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
  const auto skipped = std::ranges::count_if(result.checks, [](const Check& check) { return !check.judged; });
  const auto failures =
      std::ranges::count_if(result.checks, [](const Check& check) { return check.judged && !check.pass; });
  const std::string error = result.verdict == Verdict::kInterrupted ? "interrupted" : result.fault;
  const double time_s = result.metrics.wall_time_s.value_or(0.0);
  const std::string counts =
      fmt::format("name=\"{} seed {}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"",
                  Xml(result.scenario), result.seed, result.checks.size() + 1, failures, error.empty() ? 0 : 1, skipped,
                  std::isfinite(time_s) ? time_s : 0.0);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite " + counts + ">\n";
  xml += fmt::format("    <testcase classname=\"{}\" name=\"run\" time=\"0\"", Xml(result.scenario));
  xml += error.empty() ? "/>\n" : fmt::format(">\n      <error message=\"{}\"/>\n    </testcase>\n", Xml(error));
  for (const Check& check : result.checks) xml += TestCase(result, check);
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace merlin
