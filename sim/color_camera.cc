#include "sim/color_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/random.h"

namespace merlin::sim {
namespace {

// 2^12 equally likely values of the standard normal distribution (reaching +-3.7 sigma), scaled to variance 1.
constexpr int kQuantileBits = 12;
constexpr int kQuantiles = 1 << kQuantileBits;

// x with Phi(x) = p, p in [0.5, 1): Newton from the left, where Phi is concave and every step falls short.
double NormalQuantile(double p) {
  double x = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
    x += (p - 0.5 * std::erfc(-x / std::numbers::sqrt2)) / density;
  }
  return x;
}

std::array<float, kQuantiles> NormalTable() {
  std::array<double, kQuantiles / 2> upper{};
  double sum_of_squares = 0.0;
  for (int i = 0; i < kQuantiles / 2; ++i) {
    upper[i] = NormalQuantile(0.5 + (i + 0.5) / kQuantiles);
    sum_of_squares += upper[i] * upper[i];
  }
  const double scale = 1.0 / std::sqrt(sum_of_squares / (kQuantiles / 2));
  std::array<float, kQuantiles> table{};
  for (int i = 0; i < kQuantiles / 2; ++i) {
    table[kQuantiles / 2 + i] = static_cast<float>(scale * upper[i]);
    table[kQuantiles / 2 - 1 - i] = static_cast<float>(-scale * upper[i]);
  }
  return table;
}

std::array<float, 256> SigmaOfValue(const ColorCameraSheet& sheet) {
  std::array<float, 256> sigma{};
  for (int v = 0; v < 256; ++v)
    sigma[v] = static_cast<float>(std::sqrt(v * sheet.gain_dn_per_e + sheet.read_noise_dn * sheet.read_noise_dn));
  return sigma;
}

}  // namespace

void AddColorNoise(std::vector<std::uint8_t>& bgr, const ColorCameraSheet& sheet, std::uint64_t seed,
                   std::uint64_t frame) {
  static const std::array<float, kQuantiles> normal = NormalTable();
  const std::array<float, 256> sigma = SigmaOfValue(sheet);
  const std::array<std::uint32_t, 2> key{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
  // The counter of sim/random.h; one block serves eight neighbouring values, 16 bits each.
  const std::uint32_t sensor = static_cast<std::uint32_t>(Sensor::kColor) << 8;
  const std::uint32_t frame_low = static_cast<std::uint32_t>(frame), frame_high = frame >> 32 & 0xFF;
  for (std::size_t first = 0; first < bgr.size(); first += 8) {
    const auto block = Philox4x32({0, static_cast<std::uint32_t>(first / 8), frame_low, sensor | frame_high}, key);
    const std::size_t count = std::min<std::size_t>(8, bgr.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t bits = block[i / 2] >> (16 * (i % 2)) & 0xFFFF;
      std::uint8_t& value = bgr[first + i];
      const float noisy = value + sigma[value] * normal[bits >> (16 - kQuantileBits)];
      // Clipped as an integer: as a float the clip is a branch, which a dark picture takes at random.
      const int rounded = static_cast<int>(noisy + 0.5f);
      value = static_cast<std::uint8_t>(std::clamp(rounded, 0, 255));
    }
  }
}

}  // namespace merlin::sim
