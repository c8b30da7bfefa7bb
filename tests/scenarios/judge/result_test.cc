#include "scenarios/judge/result.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/judge/writers.h"
#include "tests/support/temporary_folder.h"

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
  result.checks = {{.name = "laps_min", .value = 1.0, .limit = 1.0, .pass = true},
                   {.name = "x_max"},
                   {.name = "y_max", .judged = false}};
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
                   {.name = "collisions_max", .value = std::nullopt, .limit = 0.0, .pass = false},
                   {.name = "coverage_percent_min", .limit = 90.0, .judged = false}};
  EXPECT_EQ(
      ToJUnit(result),
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"a&lt;b&amp;&quot;c&quot;? seed 7\" tests=\"5\" failures=\"2\" errors=\"0\" skipped=\"1\" "
      "time=\"12.500\">\n"
      "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"run\" time=\"0\"/>\n"
      "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"laps_min\" time=\"0\"/>\n"
      "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"ate_rmse_m_max\" time=\"0\">\n"
      "      <failure message=\"ate_rmse_m_max: value 0.75, limit 0.5\"/>\n    </testcase>\n"
      "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"collisions_max\" time=\"0\">\n"
      "      <failure message=\"collisions_max: value not known, limit 0\"/>\n    </testcase>\n"
      "    <testcase classname=\"a&lt;b&amp;&quot;c&quot;?\" name=\"coverage_percent_min\" time=\"0\">\n"
      "      <skipped message=\"not judged: this run cannot know it\"/>\n    </testcase>\n"
      "  </testsuite>\n</testsuites>\n");
}

// The class name of the first test case as Python's XML parser reads it; empty if the XML is not well formed.
std::string ParsedClassName(const std::string& xml) {
  const TemporaryFolder folder;
  WriteFile(folder.path() / "junit.xml", xml);
  const std::string read =
      "import sys, xml.etree.ElementTree as tree; "
      "sys.stdout.buffer.write(tree.parse('junit.xml').find('.//testcase').get('classname').encode())";
  const std::string command = "cd '" + folder.path().string() + "' && python3 -c \"" + read + "\" >name 2>error";
  return std::system(command.c_str()) == 0 ? Contents(folder.path() / "name") : "";
}

TEST(ToJUnit, KeepsEveryCharacterThatXmlMayHold) {
  for (const std::string name :
       {"Prüfung Flur <Ä>", "走廊", "\U0001F697 \"x\" & y's", "\xC2\x85", "a\tb\nc\rd", "\U0010FFFD"})
    EXPECT_EQ(ParsedClassName(ToJUnit({.scenario = name})), name);
}

TEST(ToJUnit, StaysWellFormedWhateverTheText) {
  EXPECT_EQ(ParsedClassName(ToJUnit({.scenario = "a\xff"
                                                 "b"})),
            "a\uFFFD"
            "b");
  EXPECT_EQ(ParsedClassName(ToJUnit({.scenario = "\xC3"})), "\uFFFD");
  EXPECT_EQ(ParsedClassName(ToJUnit({.scenario = std::string("\0\x01\x1F", 3)})), "???");
  EXPECT_EQ(ParsedClassName(ToJUnit({.scenario = "\xEF\xBF\xBE\xEF\xBF\xBF"})), "??");      // U+FFFE, U+FFFF
  EXPECT_EQ(ParsedClassName(ToJUnit({.scenario = "\xED\xA0\x80"})), "\uFFFD\uFFFD\uFFFD");  // a surrogate
  const std::string fault = ToJUnit({.scenario = "s", .fault = "käse\xff: \"lost\""});
  EXPECT_NE(fault.find("<error message=\"käse\uFFFD: &quot;lost&quot;\"/>"), std::string::npos) << fault;
}

TEST(ToJUnit, ReportsAnInterruptedRunAsAnError) {
  const std::string xml = ToJUnit({.scenario = "s", .verdict = Verdict::kInterrupted});
  EXPECT_NE(xml.find("errors=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("<error message=\"interrupted\"/>"), std::string::npos);
}

}  // namespace
}  // namespace merlin
