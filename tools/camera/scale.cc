#include "tools/camera/scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace merlin {
namespace {

constexpr double kTicks = 7.0;      // about as many on an axis
constexpr double kRounding = 1e-9;  // of a step

double Step(double length) {
  const double raw = length / kTicks, power = std::pow(10.0, std::floor(std::log10(raw))), digit = raw / power;
  return power * (digit > 5.0 ? 10.0 : digit > 2.0 ? 5.0 : digit > 1.0 ? 2.0 : 1.0);
}

Scale Linear(double low, double high) {
  if (!(high - low > kRounding * std::max(std::abs(low), std::abs(high)))) {
    const double half = low == 0.0 ? 1.0 : 0.5 * std::abs(low);
    low -= half;
    high += half;
  }
  const double step = Step(high - low);
  const double first = std::floor(low / step + kRounding), last = std::ceil(high / step - kRounding);
  Scale scale{.low = first * step, .high = last * step};
  for (double i = first; i <= last; i += 1.0) {
    const double value = i * step;
    scale.ticks.push_back({value, fmt::format("{:.6g}", i == 0.0 ? 0.0 : value)});
  }
  return scale;
}

// 1, 2, 5 times powers of ten; over more than three decades the powers alone.
Scale Logarithmic(double low, double high) {
  const std::initializer_list<double> digits{1.0, 2.0, 5.0};
  std::vector<double> marks;
  for (int e = static_cast<int>(std::floor(std::log10(low))) - 1;
       e <= static_cast<int>(std::ceil(std::log10(high))) + 1; ++e)
    for (const double digit : digits) marks.push_back(digit * std::pow(10.0, e));
  const auto first = std::prev(std::upper_bound(marks.begin(), marks.end(), low * (1.0 + kRounding)));
  auto last = std::lower_bound(marks.begin(), marks.end(), high * (1.0 - kRounding));
  if (last == first) ++last;
  Scale scale{.low = *first, .high = *last, .logarithmic = true};
  const bool few = *last / *first < 2e3;
  for (auto mark = first; mark <= last; ++mark)
    if (few || (mark - marks.begin()) % 3 == 0) scale.ticks.push_back({*mark, fmt::format("{:.6g}", *mark)});
  return scale;
}

}  // namespace

double Scale::Share(double value) const {
  return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

Scale ScaleFor(std::span<const double> values, const Axis& axis) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const double value : values) {
    if (!std::isfinite(value) || (axis.logarithmic && value <= 0.0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) low = high = 1.0;
  return axis.logarithmic ? Logarithmic(low, high) : Linear(low, high);
}

}  // namespace merlin
