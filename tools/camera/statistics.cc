#include "tools/camera/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace merlin {

double UnwrapNear(double value, double reference, double period) {
  return value + period * std::round((reference - value) / period);
}

void PixelSamples::Add(double range_m) {
  ++count;
  const double before_m = range_m - mean_m;
  mean_m += before_m / static_cast<double>(count);
  squares_m2 += before_m * (range_m - mean_m);
}

RangeStatistics Pool(const std::vector<PixelSamples>& pixels) {
  RangeStatistics pooled;
  double sum_m = 0.0, squares_m2 = 0.0, freedoms = 0.0;
  for (const PixelSamples& pixel : pixels) {
    if (pixel.count == 0) continue;
    pooled.samples += pixel.count;
    sum_m += static_cast<double>(pixel.count) * pixel.mean_m;
    squares_m2 += pixel.squares_m2;
    freedoms += static_cast<double>(pixel.count - 1);
  }
  if (pooled.samples > 0) pooled.mean_m = sum_m / static_cast<double>(pooled.samples);
  if (freedoms > 0.0) pooled.sigma_m = std::sqrt(squares_m2 / freedoms);
  return pooled;
}

double Median(std::vector<double> values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace merlin
