#include "tools/sweep/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace merlin {
namespace {

// The bounds are where the true share p and the observed one differ by 1.96 standard deviations for p.
TEST(ShareInterval, HasItsBoundsWhereTheObservedShareIs1_96SigmasOff) {
  for (const int runs : {1, 5, 40})
    for (int passed = 0; passed <= runs; ++passed) {
      const Interval interval = ShareInterval(passed, runs);
      const double share = static_cast<double>(passed) / runs;
      for (const double p : {interval.low, interval.high}) {
        if (p < 1e-12 || p > 1.0 - 1e-12) continue;
        EXPECT_NEAR(std::abs(share - p) / std::sqrt(p * (1.0 - p) / runs), 1.96, 1e-3) << passed << "/" << runs;
      }
      EXPECT_LE(interval.low, share);
      EXPECT_GE(interval.high, share);
    }
}

TEST(ShareInterval, KeepsToZeroAndOne) {
  EXPECT_EQ(ShareInterval(0, 5).low, 0.0);
  EXPECT_NEAR(ShareInterval(0, 5).high, 0.434, 0.001);  // z^2 / (n + z^2), by hand
  EXPECT_NEAR(ShareInterval(5, 5).low, 0.566, 0.001);
  EXPECT_EQ(ShareInterval(5, 5).high, 1.0);
}

TEST(Spread, OfNothingIsNothing) { EXPECT_FALSE(SpreadOf({})); }

TEST(Spread, OfOneValueIsThatValueWithoutConfidence) {
  const auto spread = SpreadOf(std::vector<double>{3.0});
  ASSERT_TRUE(spread);
  EXPECT_EQ(spread->median, 3.0);
  EXPECT_EQ(spread->worst, 3.0);
  EXPECT_EQ(spread->of_median.low, 3.0);
  EXPECT_EQ(spread->of_median.high, 3.0);
  EXPECT_EQ(spread->of_median.confidence, 0.0);
}

// Ranks from the table of the sign test: 5 values: 1 and 5 (93.75 %); 6: 1 and 6 (96.9 %); 10: 2 and 9 (97.9 %);
// 20: 6 and 15 (95.9 %).
TEST(Spread, HasTheRanksOfTheSignTest) {
  struct Case {
    int count, low, high;
    double confidence;
  };
  for (const Case& c :
       {Case{5, 1, 5, 0.9375}, Case{6, 1, 6, 0.96875}, Case{10, 2, 9, 0.978516}, Case{20, 6, 15, 0.958611}}) {
    std::vector<double> values;
    for (int i = c.count; i >= 1; --i) values.push_back(i);
    const auto spread = SpreadOf(values);
    EXPECT_EQ(spread->of_median.low, c.low) << c.count;
    EXPECT_EQ(spread->of_median.high, c.high) << c.count;
    EXPECT_NEAR(spread->of_median.confidence, c.confidence, 1e-5) << c.count;
    EXPECT_EQ(spread->median, 0.5 * (c.count + 1));
    EXPECT_EQ(spread->worst, c.count);
  }
}

TEST(Spread, HoldsTheMedianAsOftenAsItSays) {
  std::mt19937 generator(1);
  std::exponential_distribution<double> skewed(1.0);
  const double median = std::log(2.0);
  constexpr int kTrials = 4000;
  int held = 0;
  double confidence = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(12);
    for (double& value : values) value = skewed(generator);
    const auto spread = SpreadOf(values);
    held += spread->of_median.low <= median && median <= spread->of_median.high;
    confidence = spread->of_median.confidence;
  }
  EXPECT_NEAR(static_cast<double>(held) / kTrials, confidence, 0.015);  // 4 sigma of the trials
}

}  // namespace
}  // namespace merlin
