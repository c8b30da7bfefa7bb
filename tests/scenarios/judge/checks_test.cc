#include "scenarios/judge/checks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "robot/base/error.h"

namespace merlin {
namespace {

Check EvaluateOne(const std::string& name, double limit, const Metrics& metrics, bool knows_truth = true) {
  return Evaluate({{name, limit}}, metrics, knows_truth, "test").at(0);
}

TEST(Evaluate, PassesAtTheLimitAndFailsBeyond) {
  Metrics metrics;
  metrics.ate_rmse_m = 0.5;
  metrics.laps = 1;
  EXPECT_TRUE(EvaluateOne("ate_rmse_m_max", 0.5, metrics).pass);
  EXPECT_FALSE(EvaluateOne("ate_rmse_m_max", 0.49, metrics).pass);
  EXPECT_TRUE(EvaluateOne("laps_min", 1, metrics).pass);
  EXPECT_FALSE(EvaluateOne("laps_min", 2, metrics).pass);
  const Check check = EvaluateOne("laps_max", 0, metrics);
  EXPECT_EQ(check.name, "laps_max");
  EXPECT_EQ(check.value, 1.0);
  EXPECT_EQ(check.limit, 0.0);
  EXPECT_FALSE(check.pass);
}

TEST(Evaluate, FailsWhatIsNotKnownOrNotFinite) {
  Metrics metrics;
  for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    metrics.ate_rmse_m = value;
    EXPECT_FALSE(EvaluateOne("ate_rmse_m_max", 1e9, metrics).pass);
    EXPECT_FALSE(EvaluateOne("ate_rmse_m_min", -1e9, metrics).pass);
    EXPECT_FALSE(EvaluateOne("ate_rmse_m_max", 1e9, metrics).value);
  }
  EXPECT_FALSE(EvaluateOne("collisions_max", 0, {}).pass);
  EXPECT_FALSE(EvaluateOne("coverage_percent_min", 0, {}).pass);
}

TEST(Evaluate, WantsBothValuesOfAMetricOfTwo) {
  Metrics metrics;
  metrics.map_size_error_percent = {0.5, 1.5};
  EXPECT_TRUE(EvaluateOne("map_size_error_percent_max", 2, metrics).pass);
  EXPECT_EQ(EvaluateOne("map_size_error_percent_max", 1, metrics).value, 1.5);
  EXPECT_FALSE(EvaluateOne("map_size_error_percent_max", 1, metrics).pass);
  EXPECT_EQ(EvaluateOne("map_size_error_percent_min", 0, metrics).value, 0.5);
  metrics.map_size_error_percent = {0.5, std::nullopt};
  EXPECT_FALSE(EvaluateOne("map_size_error_percent_max", 2, metrics).pass);
  EXPECT_TRUE(EvaluateOne("map_size_error_percent.0_max", 0.5, metrics).pass);
  EXPECT_FALSE(EvaluateOne("map_size_error_percent.0_max", 0.4, metrics).pass);
  EXPECT_FALSE(EvaluateOne("map_size_error_percent.1_max", 2, metrics).pass);
}

TEST(Evaluate, ReachesNestedAndObstacleFigures) {
  Metrics metrics;
  metrics.stack_ms.p99 = 7.0;
  metrics.obstacle_gap_m = 0.4;
  EXPECT_TRUE(EvaluateOne("stack_ms.p99_max", 10, metrics).pass);
  EXPECT_TRUE(EvaluateOne("obstacle_gap_m_min", 0.3, metrics).pass);
}

TEST(Evaluate, RefusesAnUnknownNameAndNamesTheNearest) {
  const auto message = [](const CheckLimit& limit) -> std::string {
    try {
      RequireKnown(limit, "scenarios/x.yaml:9");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({"ate_rms_m_max", 1}).find("nearest is 'ate_rmse_m_max'"), std::string::npos);
  EXPECT_NE(message({"ate_rms_m_max", 1}).find("scenarios/x.yaml:9"), std::string::npos);
  EXPECT_NE(message({"collisions", 0}).find("nearest is 'collisions_max'"), std::string::npos);
  EXPECT_NE(message({"", 0}).find("unknown check ''"), std::string::npos);
  EXPECT_NE(message({"stack_ms_max", 0}).find("unknown check"), std::string::npos);
  EXPECT_NE(message({"laps_min", std::nan("")}).find("a finite number"), std::string::npos);
  EXPECT_EQ(message({"laps_min", 1}), "");
  EXPECT_THROW(Evaluate({{"lap_min", 1}}, {}, true, "x"), InputError);
}

// Every metric that a check may name, and whether it compares with the truth, listed by what it means.
TEST(Evaluate, DoesNotJudgeWithoutTruthWhatComparesWithIt) {
  for (const char* name :
       {"laps_min", "collisions_max", "ate_rmse_m_max", "ate_online_rmse_m_max", "rpe_translation_percent_max",
        "rpe_rotation_deg_per_m_max", "map_size_m_min", "map_size_m.0_min", "map_size_error_percent_max",
        "map_size_error_percent.1_max", "map_to_plan_p95_m_max", "coverage_percent_min", "obstacle_gap_m_min",
        "obstacle_stop_s_min"}) {
    EXPECT_FALSE(EvaluateOne(name, 0, {}, false).judged) << name;
    EXPECT_FALSE(EvaluateOne(name, 0, {}, false).pass) << name;
    EXPECT_TRUE(EvaluateOne(name, 0, {}, true).judged) << name;
  }
  for (const char* name :
       {"sim_time_s_min", "wall_time_s_max", "setup_s_max", "real_time_factor_min", "distance_m_min",
        "loops_closed_min", "place_found_s_max", "place_found_m_max", "depth_frames_min", "color_frames_min",
        "frames_dropped_max", "stack_ms.p50_max", "peak_rss_mb_max", "stack_rss_mb_max"})
    EXPECT_TRUE(EvaluateOne(name, 0, {}, false).judged) << name;
  EXPECT_FALSE(EvaluateOne("stack_rss_mb_max", 512, {}, true).judged);  // the simulation runs in the same process
  Metrics metrics;
  metrics.distance_m = 9.0;
  EXPECT_TRUE(EvaluateOne("distance_m_min", 8, metrics, false).pass);
  EXPECT_FALSE(EvaluateOne("distance_m_min", 10, metrics, false).pass);
  EXPECT_FALSE(EvaluateOne("frames_dropped_max", 0, {}, false).pass);  // it could be known, but is not
}

TEST(Judge, FailsWithAnyCheck) {
  EXPECT_EQ(Judge({}), Verdict::kNotJudged);
  EXPECT_EQ(Judge({{.judged = false}, {.judged = false}}), Verdict::kNotJudged);
  EXPECT_EQ(Judge({{.judged = false}, {.pass = true}}), Verdict::kPass);
  EXPECT_EQ(Judge({{.pass = false}, {.judged = false}, {.pass = true}}), Verdict::kFail);
  EXPECT_EQ(Judge({{.pass = true}, {.pass = true}}), Verdict::kPass);
  EXPECT_EQ(Judge({{.pass = true}, {.pass = false}}), Verdict::kFail);
}

}  // namespace
}  // namespace merlin
