#include "sim/tof/normal_row.h"

#include <bit>
#include <cmath>
#include <numbers>

#include "sim/tof/sin_cos.h"

namespace merlin::sim {
namespace {

constexpr float kPerStep_rad = std::numbers::pi_v<float> * 0x1p-31f;

// Natural logarithm of x in (0, 1], error < 2e-7 (absolute or relative): the minimax polynomial of Cephes (Moshier,
// logf), without branches. x is at least 2^-33.
inline float Log(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  float exponent = static_cast<float>(static_cast<int>(bits >> 23) - 126);
  float m = std::bit_cast<float>((bits & 0x007FFFFFu) | 0x3F000000u);  // [0.5, 1)
  const bool low = m < 0.70710678f;
  exponent -= low ? 1.0f : 0.0f;
  m = (low ? m + m : m) - 1.0f;
  const float z = m * m;
  float y = 7.0376836292e-2f;
  y = y * m - 1.1514610310e-1f;
  y = y * m + 1.1676998740e-1f;
  y = y * m - 1.2420140846e-1f;
  y = y * m + 1.4249322787e-1f;
  y = y * m - 1.6668057665e-1f;
  y = y * m + 2.0000714765e-1f;
  y = y * m - 2.4999993993e-1f;
  y = y * m + 3.3333331174e-1f;
  y = y * m * z - 2.12194440e-4f * exponent - 0.5f * z;
  return m + y + 0.693359375f * exponent;
}

// Uniform in (0, 1], in steps of 2^-32 or the resolution of a float; small values are exact.
inline float Uniform(std::uint32_t word) {
  return static_cast<float>(static_cast<int>(word >> 16)) * 0x1p-16f +
         (static_cast<float>(static_cast<int>(word & 0xFFFF)) + 0.5f) * 0x1p-32f;
}

}  // namespace

void NormalRow::Draw(std::uint64_t seed, Sensor sensor, std::uint64_t frame, std::uint32_t first_pixel,
                     std::uint16_t purpose, std::uint32_t draw) {
  const std::array<std::uint32_t, 2> key{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
  const std::uint32_t stream = static_cast<std::uint32_t>(frame >> 32 & 0xFF) |
                               static_cast<std::uint32_t>(sensor) << 8 | std::uint32_t{purpose} << 16;
  for (std::size_t first = 0; first < count_; first += 8) {
    const PhiloxOctet words = Philox4x32Octet(
        {draw, first_pixel + static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(frame), stream}, key);
    for (std::size_t pair = 0; pair < 2; ++pair) {
      // Box and Muller, "A note on the generation of random normal deviates", Ann. Math. Stat. 29 (1958).
      std::array<float, 8> radius, angle, sine, cosine;
      for (std::size_t i = 0; i < 8; ++i) {
        radius[i] = std::sqrt(-2.0f * Log(Uniform(words[2 * pair][i])));
        angle[i] = static_cast<float>(static_cast<std::int32_t>(words[2 * pair + 1][i])) * kPerStep_rad;
      }
      SinCos(angle, sine, cosine);
      for (std::size_t i = 0; i < 8; ++i) {
        of[2 * pair][first + i] = radius[i] * cosine[i];
        of[2 * pair + 1][first + i] = radius[i] * sine[i];
      }
    }
  }
}

}  // namespace merlin::sim
