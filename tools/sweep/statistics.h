// What a handful of runs tells of all the runs there could be.
#pragma once

#include <optional>
#include <span>

namespace merlin {

struct Interval {
  double low = 0.0, high = 0.0;
  double confidence = 0.0;  // that the true value lies within
};

// Of a share, from how many of how many (at least one): the score interval at 95 %.
// E. B. Wilson, "Probable inference, the law of succession, and statistical inference", JASA 22, 1927.
Interval ShareInterval(int passed, int runs);

struct Spread {
  double median = 0.0, worst = 0.0;  // the largest
  Interval of_median;
  int count = 0;
};

// Nothing without values. The interval lies between two of the values, whatever their distribution: each is below the true
// median with chance 1/2. It is the narrowest with 95 %, or as wide as the values where they are too few for that (five:
// 93.75 %).
// H. A. David and H. N. Nagaraja, "Order Statistics", 3rd edition, 2003, section 7.1.
std::optional<Spread> SpreadOf(std::span<const double> values);

}  // namespace merlin
