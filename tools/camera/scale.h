// Chooses the range of an axis and where its ticks are.
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

// Covers all finite values (on a logarithmic axis: all finite values above 0). Both ends are multiples of a step, which is 1,
// 2 or 5 times a power of ten. The scale has a length even if there is no value, or only one.
Scale ScaleFor(std::span<const double> values, const Axis& axis);

}  // namespace merlin
