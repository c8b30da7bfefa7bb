#include "robot/base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace merlin {
namespace {

using Counter = std::array<std::uint32_t, 4>;
using Key = std::array<std::uint32_t, 2>;

// Known answers published with Random123 (kat_vectors, philox4x32 10).
TEST(Philox, GivesTheKnownAnswers) {
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(Philox4x32({0, 0, 0, 0}, {0, 0}), (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(Philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(Philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, Key{0xa4093822, 0x299f31d0}),
            (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

double Correlation(Random a, Random b) {
  constexpr int kDraws = 20000;
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) sum += (a.Uniform() - 0.5) * (b.Uniform() - 0.5) * 12.0;
  return sum / kDraws;
}

TEST(Random, IsTheSameStreamForTheSameKey) {
  Random a(1, Sensor::kDepth, 2, 3, 4), b(1, Sensor::kDepth, 2, 3, 4);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(a.Normal(), b.Normal());
}

TEST(Random, IsAnIndependentStreamWhenAnyPartOfTheKeyDiffers) {
  constexpr std::uint64_t kHigh = std::uint64_t{1} << 32;
  const Random base(1, Sensor::kDepth, 2, 3, 4);
  const std::vector<Random> others{
      Random(2, Sensor::kDepth, 2, 3, 4),         Random(1 + kHigh, Sensor::kDepth, 2, 3, 4),
      Random(1, Sensor::kColor, 2, 3, 4),         Random(1, Sensor::kDepth, 3, 3, 4),
      Random(1, Sensor::kDepth, 2 + kHigh, 3, 4), Random(1, Sensor::kDepth, 2, 4, 4),
      Random(1, Sensor::kDepth, 2, 3, 5),         Random(1, Sensor::kDepth, 3, 2, 4),
  };
  // Of independent uniform numbers the correlation of n pairs has sigma 1 / sqrt(n) = 0.0071.
  for (const Random& other : others) EXPECT_LT(std::abs(Correlation(base, other)), 4.5 * 0.0071);
  EXPECT_NEAR(Correlation(base, base), 1.0, 0.05);
}

TEST(Random, IsIndependentFromPixelToPixelAndFrameToFrame) {
  // First draws along pixels and frames, 16 x 16 bins of neighbours: chi-square of 255 degrees of freedom, sigma 22.6.
  constexpr int kPixels = 200, kFrames = 128;
  const auto first = [](int frame, int pixel) {
    return Random(7, Sensor::kDepth, static_cast<std::uint64_t>(frame), static_cast<std::uint32_t>(pixel)).Uniform();
  };
  std::vector<int> along_pixels(256), along_frames(256);
  for (int f = 0; f < kFrames; f += 2) {
    for (int p = 0; p < kPixels; p += 2) {
      const int bin = static_cast<int>(first(f, p) * 16) * 16;
      ++along_pixels[static_cast<std::size_t>(bin + static_cast<int>(first(f, p + 1) * 16))];
      ++along_frames[static_cast<std::size_t>(bin + static_cast<int>(first(f + 1, p) * 16))];
    }
  }
  const double expected = kPixels * kFrames / 4 / 256.0;
  for (const auto& bins : {along_pixels, along_frames}) {
    double chi_square = 0.0;
    for (const int count : bins) chi_square += (count - expected) * (count - expected) / expected;
    EXPECT_NEAR(chi_square, 255.0, 4.5 * 22.6);
  }
}

struct Moments {
  double mean = 0.0, variance = 0.0, skewness = 0.0, kurtosis = 0.0;
};

template <class Draw>
Moments Measure(int n, Draw draw) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(draw());
  Moments moments;
  for (const double v : values) moments.mean += v / n;
  for (const double v : values) moments.variance += std::pow(v - moments.mean, 2) / n;
  const double sigma = std::sqrt(moments.variance);
  for (const double v : values) moments.skewness += std::pow((v - moments.mean) / sigma, 3) / n;
  for (const double v : values) moments.kurtosis += std::pow((v - moments.mean) / sigma, 4) / n;
  return moments;
}

constexpr int kDraws = 100000;
const double kStandardError = 1.0 / std::sqrt(kDraws);  // of the mean of a variable of sigma 1

TEST(Random, UniformFillsTheOpenUnitInterval) {
  Random random(1, Sensor::kDepth, 0);
  double low = 1.0, high = 0.0;
  const Moments moments = Measure(kDraws, [&] {
    const double value = random.Uniform();
    low = std::min(low, value);
    high = std::max(high, value);
    return value;
  });
  EXPECT_GT(low, 0.0);
  EXPECT_LT(high, 1.0);
  EXPECT_NEAR(moments.mean, 0.5, 4.5 * kStandardError * std::sqrt(1.0 / 12.0));
  EXPECT_NEAR(moments.variance, 1.0 / 12.0, 4.5 * kStandardError * std::sqrt(1.0 / 180.0));
}

TEST(Random, NormalHasTheMomentsAndTailOfAGaussian) {
  Random random(1, Sensor::kDepth, 0);
  int beyond_two_sigma = 0;
  const Moments moments = Measure(kDraws, [&] {
    const double value = random.Normal();
    beyond_two_sigma += std::abs(value) > 2.0;
    return value;
  });
  EXPECT_NEAR(moments.mean, 0.0, 4.5 * kStandardError);
  EXPECT_NEAR(moments.variance, 1.0, 4.5 * kStandardError * std::sqrt(2.0));
  EXPECT_NEAR(moments.skewness, 0.0, 4.5 * kStandardError * std::sqrt(6.0));
  EXPECT_NEAR(moments.kurtosis, 3.0, 4.5 * kStandardError * std::sqrt(24.0));
  const double share = std::erfc(std::sqrt(2.0));
  EXPECT_NEAR(beyond_two_sigma / double{kDraws}, share, 4.5 * kStandardError * std::sqrt(share * (1.0 - share)));
}

TEST(Random, PoissonHasItsMeanAsVarianceOnBothSidesOfTheGaussianLimit) {
  for (const double mean : {0.01, 1.0, 12.5, 49.9, 50.1, 4000.0}) {
    Random random(1, Sensor::kDepth, 0);
    const Moments moments = Measure(kDraws, [&] { return random.Poisson(mean); });
    EXPECT_NEAR(moments.mean, mean, 4.5 * kStandardError * std::sqrt(mean)) << mean;
    EXPECT_NEAR(moments.variance, mean, 4.5 * kStandardError * std::sqrt(mean + 2.0 * mean * mean)) << mean;
  }
}

TEST(Random, PoissonCountsFollowTheProbabilities) {
  Random random(3, Sensor::kDepth, 0);
  std::map<double, int> counts;
  for (int i = 0; i < kDraws; ++i) ++counts[random.Poisson(3.0)];
  double probability = std::exp(-3.0);
  for (int k = 0; k < 10; ++k) {
    EXPECT_NEAR(counts[k] / double{kDraws}, probability, 4.5 * kStandardError * std::sqrt(probability)) << k;
    probability *= 3.0 / (k + 1);
  }
}

TEST(Random, PoissonOfZeroIsZero) {
  Random random(1, Sensor::kDepth, 0);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(random.Poisson(0.0), 0.0);
}

TEST(Philox, EightBlocksAtOnceAreTheEightBlocks) {
  const std::array<std::uint32_t, 2> key{0xDEADBEEF, 7};
  for (const std::uint32_t first : {0u, 12u, 0xFFFFFFFAu}) {  // the last wraps, in its own word
    const PhiloxOctet words = Philox4x32Octet({3, first, 5, 0x200}, key);
    for (std::uint32_t i = 0; i < 8; ++i)
      EXPECT_EQ((Counter{words[0][i], words[1][i], words[2][i], words[3][i]}),
                Philox4x32({3, first + i, 5, 0x200}, key))
          << first << " " << i;
  }
}

TEST(Random, GivesOutFirstWhatItWasGiven) {
  Random random(1, Sensor::kDepth, 0), untouched(1, Sensor::kDepth, 0);
  random.Give(3.0f, -4.0f);
  EXPECT_EQ(random.Normal(), 3.0);
  EXPECT_EQ(random.Normal(), -4.0);
  EXPECT_EQ(random.Normal(), untouched.Normal());
}

}  // namespace
}  // namespace merlin
