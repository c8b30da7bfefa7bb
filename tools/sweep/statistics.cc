#include "tools/sweep/statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace merlin {
namespace {

constexpr double kConfidence = 0.95;
constexpr double kSigmas = 1.959963984540054;  // for 95 %

}  // namespace

Interval ShareInterval(int passed, int runs) {
  const double n = runs, share = passed / n, z2 = kSigmas * kSigmas;
  const double middle = (share + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half = kSigmas / (1.0 + z2 / n) * std::sqrt(share * (1.0 - share) / n + z2 / (4.0 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half), kConfidence};
}

std::optional<Spread> SpreadOf(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const std::size_t n = sorted.size();
  // The median lies at or below the k-th value from either end with probability P(X < k), X binomial(n, 1/2).
  double chance = std::pow(0.5, static_cast<double>(n)), tail = chance;
  std::size_t k = 1;
  double confidence = std::max(0.0, 1.0 - 2.0 * tail);
  while (2 * (k + 1) <= n) {
    chance *= static_cast<double>(n - k + 1) / static_cast<double>(k);
    if (1.0 - 2.0 * (tail + chance) < kConfidence) break;
    tail += chance;
    confidence = 1.0 - 2.0 * tail;
    ++k;
  }
  return Spread{.median = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]),
                .worst = sorted.back(),
                .of_median = {sorted[k - 1], sorted[n - k], confidence},
                .count = static_cast<int>(n)};
}

}  // namespace merlin
