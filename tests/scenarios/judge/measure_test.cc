#include "scenarios/judge/measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace merlin {
namespace {

// 1 m along x, then 1 m along y, with a pose every 0.1 m and 0.1 s; all of it shifted to the left of the first leg.
Trajectory Corner(double left_m = 0.0) {
  Trajectory path;
  for (int i = 0; i <= 20; ++i)
    path.push_back({FromSeconds(0.1 * i), FromXyYaw(0.1 * std::min(i, 10), left_m + 0.1 * std::max(i - 10, 0), 0)});
  return path;
}

StackOutcome Outcome(const Trajectory& estimate) {
  return {.estimate = estimate, .online = estimate, .map = {}, .grid = {}, .path_m = 3.5, .loops_closed = 2};
}

GroundTruth Truth(const Trajectory& path) {
  return {.path = path,
          .outline_m = {},
          .collisions = 3,
          .obstacle_gap_m = 0.25,
          .range_m = [](const Eigen::Vector3d&, const Eigen::Vector3d&) { return HUGE_VAL; }};
}

TEST(Measure, TakesTheDistanceOfTheOdometryWhereNobodyKnowsTheTruth) {
  FirstFault faults;
  const Metrics m = Measure(Outcome(Corner()), nullptr, faults).metrics;
  EXPECT_EQ(m.distance_m, 3.5);
  EXPECT_EQ(m.loops_closed, 2);
  for (const auto& figure : {m.ate_rmse_m, m.ate_online_rmse_m, m.rpe_translation_percent, m.map_to_plan_p95_m,
                             m.coverage_percent, m.obstacle_gap_m})
    EXPECT_FALSE(figure);
  EXPECT_FALSE(m.laps);
  EXPECT_FALSE(m.collisions);
  EXPECT_FALSE(faults.get());
}

TEST(Measure, TakesTheTruthWhereItIsKnown) {
  FirstFault faults;
  const GroundTruth truth = Truth(Corner());
  const Measured measured = Measure(Outcome(Corner(0.3)), &truth, faults);
  const Metrics& m = measured.metrics;
  EXPECT_NEAR(*m.distance_m, 2.0, 1e-9);
  EXPECT_NEAR(*m.ate_rmse_m, 0.0, 1e-9);  // a shift is aligned away
  EXPECT_NEAR(measured.T_world_map.translation().y(), -0.3, 1e-9);
  EXPECT_EQ(m.collisions, 3);
  EXPECT_EQ(m.obstacle_gap_m, 0.25);
  EXPECT_FALSE(m.obstacle_stop_s);
  EXPECT_FALSE(faults.get());
}

TEST(Measure, KeepsTheFaultOfTheTruthAndTheFiguresThatCame) {
  FirstFault faults;
  GroundTruth truth = Truth(Corner());
  truth.range_m = [](const Eigen::Vector3d&, const Eigen::Vector3d&) -> double { throw std::runtime_error("no rays"); };
  StackOutcome outcome = Outcome(Corner());
  for (int i = 0; i < 400; ++i)  // a wall 1 m to the left, so that there is something to measure
    outcome.map.push_back(
        {.p_map = {0.01f * static_cast<float>(i % 40), 1.0f, 0.5f + 0.05f * static_cast<float>(i / 40)}});
  const Metrics m = Measure(outcome, &truth, faults).metrics;
  EXPECT_TRUE(faults.get());
  EXPECT_NEAR(*m.ate_rmse_m, 0.0, 1e-9);
  EXPECT_FALSE(m.map_to_plan_p95_m);
}

TEST(Measure, GivesNothingForNoFrames) {
  FirstFault faults;
  const GroundTruth truth = Truth({});
  const Metrics m = Measure(Outcome({}), &truth, faults).metrics;
  EXPECT_EQ(m.distance_m, 0.0);
  EXPECT_FALSE(m.ate_rmse_m);
  EXPECT_FALSE(m.stack_ms.p50);
  EXPECT_FALSE(faults.get());
}

TEST(Measure, TakesPercentilesOfTheStacksTimes) {
  FirstFault faults;
  StackOutcome outcome = Outcome({});
  for (int i = 100; i >= 0; --i) outcome.stack_ms.push_back(i);
  const StackTimes times = Measure(outcome, nullptr, faults).metrics.stack_ms;
  EXPECT_EQ(times.p50, 50.0);
  EXPECT_EQ(times.p99, 99.0);
  EXPECT_EQ(times.max, 100.0);
}

}  // namespace
}  // namespace merlin
