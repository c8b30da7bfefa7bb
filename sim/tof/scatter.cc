#include "sim/tof/scatter.h"

#include <cmath>
#include <cstddef>

namespace merlin::sim {
namespace {

// out[i] = sum of kernel[|k|] in[i + k] for n values with a stride of `lanes`; values outside are dark.
void Convolve(std::span<const float> in, std::span<float> out, std::size_t n, std::size_t lanes,
              std::span<const float> kernel) {
  for (std::size_t i = 0; i < n; ++i) {
    float* to = out.data() + i * lanes;
    for (std::size_t l = 0; l < lanes; ++l) to[l] = kernel[0] * in[i * lanes + l];
    for (std::size_t k = 1; k < kernel.size(); ++k) {
      const float weight = kernel[k];
      if (i >= k) {
        const float* from = in.data() + (i - k) * lanes;
        for (std::size_t l = 0; l < lanes; ++l) to[l] += weight * from[l];
      }
      if (i + k < n) {
        const float* from = in.data() + (i + k) * lanes;
        for (std::size_t l = 0; l < lanes; ++l) to[l] += weight * from[l];
      }
    }
  }
}

void Transpose(std::span<const float> in, std::span<float> out, std::size_t width, std::size_t height) {
  for (std::size_t v = 0; v < height; ++v)
    for (std::size_t u = 0; u < width; ++u) out[u * height + v] = in[v * width + u];
}

}  // namespace

Scatter::Scatter(int width, int height, const DepthCameraErrors& errors)
    : width_(width),
      height_(height),
      share_(static_cast<float>(errors.scatter_share)),
      flat_(static_cast<float>(errors.scatter_flat)) {
  const double sigma_px = errors.scatter_sigma * width;
  const int reach = sigma_px > 0.0 ? static_cast<int>(std::ceil(3.0 * sigma_px)) : 0;
  double sum = 0.0;
  for (int k = 0; k <= reach; ++k) {
    kernel_.push_back(k == 0 ? 1.0f : static_cast<float>(std::exp(-0.5 * k * k / (sigma_px * sigma_px))));
    sum += (k == 0 ? 1.0 : 2.0) * kernel_.back();
  }
  for (float& weight : kernel_) weight = static_cast<float>(weight / sum);
}

void Scatter::Apply(std::span<float> image) const {
  const std::size_t width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  double sum = 0.0;
  for (const float value : image) sum += value;
  const float flat = share_ * flat_ * static_cast<float>(sum / static_cast<double>(image.size()));
  std::vector<float> along_v(image.size()), turned(image.size()), along_u(image.size());
  Convolve(image, along_v, height, width, kernel_);
  Transpose(along_v, turned, width, height);
  Convolve(turned, along_u, width, height, kernel_);
  Transpose(along_u, along_v, height, width);
  const float keep = 1.0f - share_, spread = share_ * (1.0f - flat_);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = keep * image[i] + spread * along_v[i] + flat;
}

}  // namespace merlin::sim
