// Mean and temporal sigma of ranges that wrap.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace merlin {

// value + a whole number of periods, within half a period of the reference.
double UnwrapNear(double value, double reference, double period);

struct RangeStatistics {
  std::optional<double> mean_m;   // of all samples; none without samples
  std::optional<double> sigma_m;  // about each pixel's own mean, pooled over the pixels; none where no pixel has two
  std::size_t samples = 0;
};

// Running sums of one pixel (Welford, Technometrics 4(3), 1962).
struct PixelSamples {
  std::size_t count = 0;
  double mean_m = 0.0;
  double squares_m2 = 0.0;  // sum of squared deviations from the mean

  void Add(double range_m);
};

// Pooled: sqrt(sum of squared deviations / sum of (samples - 1)), over the pixels that have any.
RangeStatistics Pool(const std::vector<PixelSamples>& pixels);

double Median(std::vector<double> values);  // of one or more

}  // namespace merlin
