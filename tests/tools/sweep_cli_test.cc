// `merlin sweep` from end to end, on runs of a second.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/program.h"
#include "tests/support/until.h"
#include "tests/tools/command.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

class SweepCli : public testing::Test {
 protected:
  fs::path Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }
  Outcome Sweep(const std::string& arguments) const {
    return Merlin("sweep " + arguments, folder_.path(), "2>&1 </dev/null");
  }

  const TemporaryFolder folder_;
};

constexpr char kTwoRows[] = R"(scenario: corridor_short
seeds: 1-2
set: {sensors.color: null, duration_s: 1, checks: {collisions_max: 0}}
limits: {pass_share_min: 1}
rows:
  - {name: plain}
  - {name: dark, set: {sensors.depth.integration_us: 300}}
)";

int Lines(const std::string& text) { return static_cast<int>(std::ranges::count(text, '\n')); }

TEST_F(SweepCli, RunsEveryRowOnEverySeedAndLeavesItsTable) {
  Write("two.yaml", kTwoRows);
  const Outcome outcome = Sweep("two.yaml");
  EXPECT_EQ(outcome.code, 0) << outcome.said;
  const fs::path out = folder_.path() / "runs/two";
  for (const char* run : {"plain-1", "plain-2", "dark-1", "dark-2"})
    EXPECT_TRUE(fs::is_regular_file(out / run / "result.json")) << run;
  EXPECT_EQ(Lines(Contents(out / "table.csv")), 1 + 2 + 1);
  EXPECT_EQ(Lines(Contents(out / "runs.csv")), 1 + 4);
  EXPECT_TRUE(Contents(out / "table.png").starts_with("\x89PNG"));
  EXPECT_NE(Contents(out / "table.md").find("| dark | 2/2 |"), std::string::npos);
  EXPECT_NE(outcome.said.find("0 of 4 runs were taken over"), std::string::npos) << outcome.said;

  // The same sweep again reuses all runs. With another setting in one row it reuses those of the other row.
  const auto before = fs::last_write_time(out / "plain-1/result.json");
  EXPECT_NE(Sweep("two.yaml").said.find("4 of 4 runs were taken over"), std::string::npos);
  std::string other = kTwoRows;
  other.replace(other.find("300"), 3, "400");
  Write("two.yaml", other);
  EXPECT_NE(Sweep("two.yaml").said.find("2 of 4 runs were taken over"), std::string::npos);
  EXPECT_EQ(fs::last_write_time(out / "plain-1/result.json"), before);
}

TEST_F(SweepCli, EndsWithOneWhereALimitIsMissedAndSaysWhichRunAndWhy) {
  Write("far.yaml", R"(scenario: corridor_short
set: {sensors.color: null, duration_s: 0.5, checks: {distance_m_min: 50}}
rows:
  - {name: far, limits: {pass_share_min: 0.5}}
)");
  const Outcome outcome = Sweep("far.yaml --seeds 3");
  EXPECT_EQ(outcome.code, 1) << outcome.said;
  EXPECT_NE(outcome.said.find("MISSED: pass_share_min 0.000 (limit 0.5)"), std::string::npos) << outcome.said;
  EXPECT_NE(outcome.said.find("far seed 3: distance_m_min is "), std::string::npos) << outcome.said;
}

TEST_F(SweepCli, GivesALapOneAndAHalfTimesItsTime) {
  Write("lap.yaml", R"(scenario: corridor_short
lap_m: 0.5
set: {sensors.color: null, checks: {}}
rows:
  - {name: slow, set: {pilot.speed_m_s: 0.25}}
)");
  EXPECT_EQ(Sweep("lap.yaml").code, 0);
  EXPECT_NE(Contents(folder_.path() / "runs/lap/slow-1/scenario.yaml").find("duration_s: 3\n"), std::string::npos);
}

TEST_F(SweepCli, TellsEveryFaultOfAFileAtOnceWithItsLine) {
  const fs::path file = Write("bad.yaml", R"(scenario: corridor_short
limits: {pass_share_min: 1}
rows:
  - {name: a b}
  - {name: unknown_key, set: {sensors.depth.camra: pmd_o3}}
  - {name: unknown_camera, set: {sensors.depth.camera: pmd_o4}}
  - name: not_of_the_sheet
    set:
      sensors.depth.rate_hz: 10
      sensors.depth.frequency_mhz: 25
  - {name: seeds, seeds: 5-1}
  - {name: seeds, compared_with: sedes}
)");
  const Outcome outcome = Sweep("bad.yaml");
  EXPECT_EQ(outcome.code, 2);
  for (const char* part : {"bad.yaml:4: a row's name", "bad.yaml:5: sensors.depth.camra: unknown key",
                           "bad.yaml:6: row unknown_camera: ", "did you mean 'pmd_o3'?",
                           "bad.yaml:7: row not_of_the_sheet: pmd_3k_s: invalid modulation frequency",
                           "bad.yaml:11: ", "bad.yaml:12: a second row 'seeds'", "did you mean 'seeds'?"})
    EXPECT_NE(outcome.said.find(part), std::string::npos) << part << "\n" << outcome.said;
  EXPECT_FALSE(fs::exists(folder_.path() / "runs"));
}

TEST_F(SweepCli, RefusesUnknownRowsLimitsFilesAndFoldersOfOthers) {
  Write("two.yaml", kTwoRows);
  EXPECT_EQ(Sweep("two.yaml --row plan").code, 2);
  EXPECT_NE(Sweep("two.yaml --row plan").said.find("did you mean 'plain'?"), std::string::npos);
  EXPECT_EQ(Sweep("two.yaml --seeds 1-").code, 2);
  EXPECT_EQ(Sweep("two.yaml --jobs 0").code, 2);
  EXPECT_NE(Sweep("envelop").said.find("did you mean 'envelope'?"), std::string::npos);
  fs::create_directory(folder_.path() / "mine");
  std::ofstream(folder_.path() / "mine/letter.txt") << "dear";
  EXPECT_EQ(Sweep("two.yaml --out mine").code, 2);
  EXPECT_EQ(Contents(folder_.path() / "mine/letter.txt"), "dear");
  std::string wrong = kTwoRows;
  wrong.replace(wrong.find("pass_share_min"), 14, "pass_shares_mn");
  Write("wrong.yaml", wrong);
  const Outcome outcome = Sweep("wrong.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.said.find("wrong.yaml:4: limits.pass_shares_mn: unknown key"), std::string::npos) << outcome.said;
}

TEST_F(SweepCli, EndsItsRunsWhenItIsInterruptedAndGoesOnLater) {
  std::string long_one = kTwoRows;
  long_one.replace(long_one.find("duration_s: 1"), 13, "duration_s: 900");
  Write("long.yaml", long_one);
  Program sweep("sweep", MERLIN_BINARY, {"sweep", "long.yaml", "--jobs", "1"}, folder_.path());
  const fs::path marker = folder_.path() / "runs/long/plain-1/.merlin-run";
  ASSERT_TRUE(Until([&] { return fs::exists(marker); }));
  sweep.Signal(SIGINT);
  EXPECT_EQ(sweep.Wait(), 130) << sweep.Said();
  EXPECT_TRUE(Contents(marker).starts_with("merlin run: complete")) << "the run itself was interrupted in good order";
  EXPECT_FALSE(fs::exists(folder_.path() / "runs/long/table.md"));
  EXPECT_FALSE(fs::exists(folder_.path() / "runs/long/plain-1/sweep_key.txt")) << "not taken over";
}

TEST_F(SweepCli, TheThreeShortSettingsKeepTheirLimits) {
  const Outcome outcome = Sweep("short");
  EXPECT_EQ(outcome.code, 0) << outcome.said;
}

TEST_F(SweepCli, TheEnvelopeIsAWholeSweep) {
  const Outcome outcome =
      Sweep("envelope --row none");  // the file is read and checked completely before the row is looked up
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(Lines(outcome.said), 1) << outcome.said;
}

}  // namespace
}  // namespace merlin
