// Where the ticks of an axis stand.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace merlin {

struct Axis {
  std::string label{};  // with its unit
  bool logarithmic = false;
};

struct Tick {
  double value = 0.0;
  std::string text;
};

struct Scale {
  double low = 0.0, high = 1.0;  // low < high; both above 0 where logarithmic
  bool logarithmic = false;
  std::vector<Tick> ticks{};  // within [low, high]

  double Share(double value) const;  // 0 at low, 1 at high
};

// Covers the finite values (where logarithmic: those above 0), ends on whole steps of 1, 2 or 5 times a power of ten.
// Without any value, and with one alone, it still has a length.
Scale ScaleFor(std::span<const double> values, const Axis& axis);

}  // namespace merlin
