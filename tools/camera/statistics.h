// Mean and temporal standard deviation of ranges that wrap.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace merlin {

// The value plus that whole number of periods which brings it nearest to the reference.
double UnwrapNear(double value, double reference, double period);

struct RangeStatistics {
  std::optional<double> mean_m;  // of all samples; none if there are no samples
  std::optional<double>
      sigma_m;  // about each pixel's own mean, pooled over all pixels; none if no pixel has two samples
  std::size_t samples = 0;
};

// Running mean and variance of one pixel. Source: B. P. Welford, "Note on a method for calculating corrected sums of squares
// and products", Technometrics 4(3), 1962.
struct PixelSamples {
  std::size_t count = 0;
  double mean_m = 0.0;
  double squares_m2 = 0.0;  // sum of squared deviations from the mean

  void Add(double range_m);
};

// The pooled standard deviation is sqrt(sum of squared deviations / sum of (samples - 1)), both sums over all pixels with
// samples.
RangeStatistics Pool(const std::vector<PixelSamples>& pixels);

double Median(std::vector<double> values);  // of at least one value

}  // namespace merlin
