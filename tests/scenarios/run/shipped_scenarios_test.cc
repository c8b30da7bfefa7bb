// Every scenario that we ship starts, runs for three seconds and writes its files. `merlin test --all` runs them to the
// end and tests whether they pass.
#include <gtest/gtest.h>

#include "scenarios/config/names.h"
#include "scenarios/run/plugs.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

class ShippedScenario : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScenario, RunsForThreeSeconds) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder.path() / "run";
  const std::atomic<bool> never{false};
  RunOptions options;
  options.name = GetParam();
  options.scenario = ReadScenario(GetParam(), {"duration_s=3"});
  options.out = out;
  options.gl = Gl::kOff;
  const RunReport report = RunScenario(options, never);
  EXPECT_FALSE(report.error) << report.result.fault;
  EXPECT_EQ(report.result.fault, "");
  EXPECT_NE(report.result.verdict, Verdict::kInterrupted);
  EXPECT_GE(report.result.metrics.depth_frames.value_or(0), 2.8 * options.scenario.sensors.depth.rate_hz);
  for (const char* file :
       {"result.json", "junit.xml", "scenario.yaml", "trajectory_estimate.tum", "trajectory_online.tum",
        "trajectory_truth.tum", "map.ply", "map.pgm", "map.yaml", "map.png", "map.slam"})
    EXPECT_TRUE(std::filesystem::is_regular_file(out / file)) << file;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenario, testing::ValuesIn(ScenarioNames()),
                         [](const auto& scenario) { return scenario.param; });

}  // namespace
}  // namespace merlin
