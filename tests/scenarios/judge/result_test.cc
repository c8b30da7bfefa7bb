#include "scenarios/judge/result.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> Keys(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(ToJson, HasTheDocumentedKeysInOrderAndNullForWhatIsNotKnown) {
  const Json json = Json::parse(ToJson({}));
  EXPECT_EQ(Keys(json),
            (std::vector<std::string>{"scenario", "seed", "verdict", "checks", "metrics", "hashes", "versions"}));
  EXPECT_EQ(Keys(json["metrics"]), (std::vector<std::string>{"sim_time_s",
                                                             "wall_time_s",
                                                             "setup_s",
                                                             "real_time_factor",
                                                             "distance_m",
                                                             "laps",
                                                             "collisions",
                                                             "loops_closed",
                                                             "ate_rmse_m",
                                                             "ate_online_rmse_m",
                                                             "rpe_translation_percent",
                                                             "rpe_rotation_deg_per_m",
                                                             "map_size_m",
                                                             "map_size_error_percent",
                                                             "map_to_plan_p95_m",
                                                             "coverage_percent",
                                                             "depth_frames",
                                                             "color_frames",
                                                             "frames_dropped",
                                                             "stack_ms",
                                                             "peak_rss_mb",
                                                             "stack_rss_mb"}));
  EXPECT_EQ(Keys(json["metrics"]["stack_ms"]), (std::vector<std::string>{"p50", "p99", "max"}));
  EXPECT_EQ(Keys(json["hashes"]), (std::vector<std::string>{"state", "depth", "color", "trajectory", "map"}));
  EXPECT_EQ(json["metrics"]["map_size_m"], Json::array({nullptr, nullptr}));
  EXPECT_TRUE(json["metrics"]["ate_rmse_m"].is_null());
  EXPECT_TRUE(json["hashes"]["color"].is_null());
  EXPECT_EQ(json["checks"], Json::array());
  EXPECT_EQ(json["versions"], Json::object());
}

TEST(ToJson, CarriesTheFigures) {
  RunResult result{
      .scenario = "corridor_loop", .seed = std::numeric_limits<std::uint64_t>::max(), .verdict = Verdict::kPass};
  result.metrics.laps = 1;
  result.metrics.ate_rmse_m = 0.1;
  result.metrics.ate_online_rmse_m = std::nan("");
  result.metrics.map_size_m = {21.01, std::nullopt};
  result.metrics.stack_ms = {.p50 = 1.0, .p99 = 2.0, .max = 3.0};
  result.metrics.obstacle_gap_m = 0.35;
  result.checks = {{.name = "laps_min", .value = 1.0, .limit = 1.0, .pass = true}, {.name = "x_max"}};
  result.hashes.state = "ab";
  result.versions = {{"merlin", "0.1.0"}, {"mujoco", "4.0.0"}};
  const Json json = Json::parse(ToJson(result));
  EXPECT_EQ(json["scenario"], "corridor_loop");
  EXPECT_EQ(json["seed"].get<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(json["verdict"], "pass");
  EXPECT_TRUE(json["metrics"]["laps"].is_number_integer());
  EXPECT_EQ(json["metrics"]["ate_rmse_m"].get<double>(), 0.1);
  EXPECT_TRUE(json["metrics"]["ate_online_rmse_m"].is_null());
  EXPECT_EQ(json["metrics"]["map_size_m"], Json::array({21.01, nullptr}));
  EXPECT_EQ(json["metrics"]["stack_ms"]["p99"], 2.0);
  EXPECT_EQ(json["metrics"]["obstacle_gap_m"], 0.35);
  EXPECT_FALSE(json["metrics"].contains("obstacle_stop_s"));
  EXPECT_EQ(json["checks"][0], (Json{{"name", "laps_min"}, {"value", 1.0}, {"limit", 1.0}, {"pass", true}}));
  EXPECT_TRUE(json["checks"][1]["value"].is_null());
  EXPECT_EQ(json["hashes"]["state"], "ab");
  EXPECT_EQ(json["versions"]["mujoco"], "4.0.0");
}

TEST(ToJson, SurvivesANameThatIsNoUtf8) {
  EXPECT_EQ(Json::parse(ToJson({.scenario = "\xff\"x"}))["scenario"], "\xef\xbf\xbd\"x");
}

TEST(ToJUnit, MakesEachCheckATestCase) {
  RunResult result{.scenario = "a<b&\"c\"\x01", .seed = 7, .verdict = Verdict::kFail};
  result.metrics.wall_time_s = 12.5;
  result.checks = {{.name = "laps_min", .value = 1.0, .limit = 1.0, .pass = true},
                   {.name = "ate_rmse_m_max", .value = 0.75, .limit = 0.5, .pass = false},
                   {.name = "collisions_max", .value = std::nullopt, .limit = 0.0, .pass = false}};
  EXPECT_EQ(ToJUnit(result),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
            "  <testsuite name=\"a&lt;b&amp;&quot;c&quot;? seed 7\" tests=\"4\" failures=\"2\" errors=\"0\" "
            "time=\"12.500\">\n"
            "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"run\" time=\"0\"/>\n"
            "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"laps_min\" time=\"0\"/>\n"
            "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"ate_rmse_m_max\" time=\"0\">\n"
            "      <failure message=\"ate_rmse_m_max: value 0.75, limit 0.5\"/>\n    </testcase>\n"
            "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"collisions_max\" time=\"0\">\n"
            "      <failure message=\"collisions_max: value not known, limit 0\"/>\n    </testcase>\n"
            "  </testsuite>\n</testsuites>\n");
}

TEST(ToJUnit, ReportsAnInterruptedRunAsAnError) {
  const std::string xml = ToJUnit({.scenario = "s", .verdict = Verdict::kInterrupted});
  EXPECT_NE(xml.find("errors=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("<error message=\"interrupted\"/>"), std::string::npos);
}

}  // namespace
}  // namespace merlin
