#include "sim/tof/normal_row.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "robot/base/random.h"

namespace merlin::sim {
namespace {

using Counter = std::array<std::uint32_t, 4>;

// Box and Muller's formula in double precision, on the same random words.
TEST(NormalRow, IsBoxAndMullerOfThePixelsOwnBlock) {
  constexpr std::uint32_t kFirst = 0xFFFFFF00;  // the pixel numbers wrap around
  NormalRow row(1003);
  for (const std::uint32_t draw : {0u, 1u}) {
    row.Draw(0x1234567890ull, Sensor::kDepth, (std::uint64_t{3} << 32) + 9, kFirst, 7, draw);
    for (std::uint32_t pixel = 0; pixel < 1003; ++pixel) {
      const Counter block = Philox4x32({draw, kFirst + pixel, 9, 3u | 1u << 8 | 7u << 16}, {0x34567890, 0x12});
      for (int pair = 0; pair < 2; ++pair) {
        const double radius = std::sqrt(-2.0 * std::log((block[2 * pair] + 0.5) * 0x1p-32));
        const double angle = 2.0 * std::numbers::pi * block[2 * pair + 1] * 0x1p-32;
        EXPECT_NEAR(row.of[2 * pair][pixel], radius * std::cos(angle), 2e-3 * std::exp(-radius) + 2e-6 * radius);
        EXPECT_NEAR(row.of[2 * pair + 1][pixel], radius * std::sin(angle), 2e-3 * std::exp(-radius) + 2e-6 * radius);
      }
    }
  }
}

TEST(NormalRow, HasTheMomentsAndTailsOfTheNormalDistribution) {
  constexpr int kFrames = 500;
  NormalRow row(500);
  double sum = 0.0, squares = 0.0, cubes = 0.0, fourths = 0.0, beyond_4 = 0.0, n = 0.0;
  for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
    row.Draw(1, Sensor::kDepth, frame, 0, 1, 0);
    for (const std::vector<float>& numbers : row.of)
      for (std::size_t i = 0; i < 500; ++i) {
        const double x = numbers[i];
        sum += x, squares += x * x, cubes += x * x * x, fourths += x * x * x * x, beyond_4 += std::abs(x) > 4.0,
            n += 1.0;
      }
  }
  // Standard errors of the sample moments: variances 1, 2, 15, 96 over n.
  EXPECT_NEAR(sum / n, 0.0, 4.5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 4.5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(cubes / n, 0.0, 4.5 * std::sqrt(15.0 / n));
  EXPECT_NEAR(fourths / n, 3.0, 4.5 * std::sqrt(96.0 / n));
  const double expected = n * std::erfc(4.0 / std::numbers::sqrt2);
  EXPECT_NEAR(beyond_4, expected, 4.5 * std::sqrt(expected));
}

}  // namespace
}  // namespace merlin::sim
