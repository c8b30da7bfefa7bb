#include "tools/sweep/table.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace merlin {
namespace {

SweepOutcome Passed(double ate_m) { return {.passed = true, .completed = true, .ate_rmse_m = ate_m}; }

Sweep TwoRows() {
  Sweep sweep;
  SweepRow base, other;
  base.name = "base";
  base.limits.pass_share_min = 0.5;
  base.limits.ate_median_m_max = 0.05;
  other.name = "other";
  other.compared_with = "base";
  other.limits.ate_worst_m_max = 0.1;
  other.limits.ate_median_ratio_max = 1.2;
  sweep.rows = {base, other};
  for (const std::size_t row : {0u, 0u, 0u, 1u, 1u}) {
    SweepRun run;
    run.row = row;
    run.seed = sweep.runs.size();
    sweep.runs.push_back(run);
  }
  return sweep;
}

const LimitOutcome& Limit(const SweepFigures& row, const std::string& name) {
  return *std::ranges::find(row.limits, name, &LimitOutcome::name);
}

TEST(SweepTable, TakesPathErrorsOfCompletedRunsOnly) {
  const Sweep sweep = TwoRows();
  std::vector<SweepOutcome> outcomes{Passed(0.02), Passed(0.04), Passed(0.03), Passed(0.03), Passed(0.05)};
  outcomes[1] = {.passed = false, .completed = false, .why = "an obstacle", .ate_rmse_m = 9.0};
  const SweepTable table = MakeTable("t", sweep, outcomes);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows[0].runs, 3);
  EXPECT_EQ(table.rows[0].passed, 2);
  EXPECT_DOUBLE_EQ(table.rows[0].ate_m->median, 0.025);
  EXPECT_DOUBLE_EQ(table.rows[0].ate_m->worst, 0.03);
  EXPECT_EQ(table.rows[2].name, "all");
  EXPECT_EQ(table.rows[2].runs, 5);
  EXPECT_EQ(table.failures, std::vector<std::string>{"base seed 1: an obstacle"});
}

TEST(SweepTable, ComparesARowWithAnother) {
  const SweepTable kept =
      MakeTable("t", TwoRows(), std::vector{Passed(0.02), Passed(0.02), Passed(0.02), Passed(0.02), Passed(0.027)});
  EXPECT_NEAR(*Limit(kept.rows[1], "ate_median_ratio_max").value, 0.0235 / 0.02, 1e-12);
  EXPECT_FALSE(kept.MissesALimit());
  const SweepTable missed =
      MakeTable("t", TwoRows(), std::vector{Passed(0.02), Passed(0.02), Passed(0.02), Passed(0.03), Passed(0.03)});
  EXPECT_FALSE(Limit(missed.rows[1], "ate_median_ratio_max").kept);
  EXPECT_TRUE(missed.MissesALimit());
}

TEST(SweepTable, MissesALimitOfWhatIsNotKnown) {
  const SweepOutcome lost{.why = "lost"};
  const SweepTable table = MakeTable("t", TwoRows(), std::vector{lost, lost, lost, Passed(0.02), Passed(0.02)});
  EXPECT_FALSE(table.rows[0].ate_m);
  EXPECT_FALSE(Limit(table.rows[0], "ate_median_m_max").kept);
  EXPECT_FALSE(Limit(table.rows[0], "pass_share_min").kept);
  EXPECT_EQ(*Limit(table.rows[0], "pass_share_min").value, 0.0);
}

TEST(SweepTable, LeavesOutRowsThatWereNotRunAndWhatComparesWithThem) {
  Sweep sweep = TwoRows();
  sweep.runs.erase(sweep.runs.begin(), sweep.runs.begin() + 3);
  const SweepTable table = MakeTable("t", sweep, std::vector{Passed(0.02), Passed(0.02)});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].name, "other");
  EXPECT_EQ(table.rows[0].limits.size(), 1u);
}

TEST(SweepTable, IsWrittenAsMarkdownAndCsv) {
  const Sweep sweep = TwoRows();
  std::vector<SweepOutcome> outcomes(5, Passed(0.02));
  outcomes[4].passed = false;
  outcomes[4].why = "a \"b\", c";
  const SweepTable table = MakeTable("t", sweep, outcomes);
  const std::string markdown = ToMarkdown(table);
  EXPECT_NE(markdown.find("| base | 3/3 | 0.44-1.00 | 3 | 0.020 (0.020-0.020) | 0.020 | - | - | kept |"),
            std::string::npos)
      << markdown;
  EXPECT_NE(markdown.find("- other seed 4: a \"b\", c\n"), std::string::npos) << markdown;
  const std::string csv = ToCsv(table), runs = RunsToCsv(sweep, outcomes);
  const auto columns = [](const std::string& text) { return std::ranges::count(text.substr(0, text.find('\n')), ','); };
  EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
  EXPECT_EQ(std::ranges::count(csv, ','), 4 * columns(csv));
  EXPECT_NE(runs.find("other,4,0,1,0.02,,,,,,,,,,\"a \"\"b\"\", c\"\n"), std::string::npos) << runs;
  EXPECT_EQ(ToPng(table).substr(1, 3), "PNG");
}

}  // namespace
}  // namespace merlin
