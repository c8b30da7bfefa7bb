// Estimates from a few runs: what they say about all possible runs, with confidence intervals.
#pragma once

#include <optional>
#include <span>

namespace merlin {

struct Interval {
  double low = 0.0, high = 0.0;
  double confidence = 0.0;  // probability that the true value lies within
};

// Score interval (95 %) of a share, given `passed` of `runs` (at least one). Source: E. B. Wilson,
// "Probable inference, the law of succession, and statistical inference", JASA 22, 1927.
Interval ShareInterval(int passed, int runs);

struct Spread {
  double median = 0.0, worst = 0.0;  // worst: the largest
  Interval of_median;
  int count = 0;
};

// None without values. The interval of the median lies between two of the values and holds for any distribution,
// because each value is below the true median with probability 1/2. It is the narrowest with at least 95 %, or the full
// range of the values if there are too few (five: 93.75 %). Source: H. A. David and H. N. Nagaraja, "Order Statistics",
// 3rd edition, 2003, section 7.1.
std::optional<Spread> SpreadOf(std::span<const double> values);

}  // namespace merlin
