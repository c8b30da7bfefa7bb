#include "robot/base/random.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include <cmath>
#include <numbers>

namespace merlin {
namespace {

// Multipliers and key increments of Philox4x32 (Salmon et al. 2011, table 2 and section 3.3).
constexpr std::uint32_t kMultiplier0 = 0xD2511F53, kMultiplier1 = 0xCD9E8D57;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9, kWeyl1 = 0xBB67AE85;
constexpr int kRounds = 10;

constexpr double kGaussianAbove = 50.0;

}  // namespace

std::array<std::uint32_t, 4> Philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t product0 = std::uint64_t{kMultiplier0} * counter[0];
    const std::uint64_t product1 = std::uint64_t{kMultiplier1} * counter[2];
    counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(product1),
               static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(product0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

#ifdef __AVX2__
namespace {

// The low and the high words of eight products of 32-bit numbers.
struct Products {
  __m256i low, high;
};

Products Multiply(__m256i a, __m256i multiplier) {
  const __m256i even = _mm256_mul_epu32(a, multiplier), odd = _mm256_mul_epu32(_mm256_srli_epi64(a, 32), multiplier);
  return {_mm256_blend_epi32(even, _mm256_slli_epi64(odd, 32), 0xAA),
          _mm256_blend_epi32(_mm256_srli_epi64(even, 32), odd, 0xAA)};
}

}  // namespace

PhiloxOctet Philox4x32Octet(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  const auto all = [](std::uint32_t word) { return _mm256_set1_epi32(static_cast<int>(word)); };
  __m256i w0 = all(counter[0]), w1 = _mm256_add_epi32(all(counter[1]), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7)),
          w2 = all(counter[2]), w3 = all(counter[3]);
  for (int round = 0; round < kRounds; ++round) {
    const Products product0 = Multiply(w0, all(kMultiplier0)), product1 = Multiply(w2, all(kMultiplier1));
    w0 = _mm256_xor_si256(_mm256_xor_si256(product1.high, w1), all(key[0]));
    w2 = _mm256_xor_si256(_mm256_xor_si256(product0.high, w3), all(key[1]));
    w1 = product1.low;
    w3 = product0.low;
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  PhiloxOctet words;
  const __m256i of[4] = {w0, w1, w2, w3};
  for (int word = 0; word < 4; ++word) _mm256_storeu_si256(reinterpret_cast<__m256i*>(words[word].data()), of[word]);
  return words;
}
#else
PhiloxOctet Philox4x32Octet(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  PhiloxOctet words;
  for (std::size_t i = 0; i < 8; ++i, ++counter[1]) {
    const std::array<std::uint32_t, 4> block = Philox4x32(counter, key);
    for (std::size_t word = 0; word < 4; ++word) words[word][i] = block[word];
  }
  return words;
}
#endif

Random::Random(std::uint64_t seed, Sensor sensor, std::uint64_t frame, std::uint32_t pixel, std::uint16_t purpose)
    : counter_{0, pixel, static_cast<std::uint32_t>(frame),
               static_cast<std::uint32_t>(frame >> 32 & 0xFF) | static_cast<std::uint32_t>(sensor) << 8 |
                   std::uint32_t{purpose} << 16},
      key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {}

double Random::Uniform() {
  if (used_ == 4) {
    block_ = Philox4x32(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }
  return (block_[used_++] + 0.5) * 0x1p-32;
}

double Random::Normal() {
  if (ready_ > 0) return normals_[--ready_];
  // Box and Muller, "A note on the generation of random normal deviates", Ann. Math. Stat. 29 (1958). |value| < 6.7.
  const double radius = std::sqrt(-2.0 * std::log(Uniform()));
  const double angle = 2.0 * std::numbers::pi * Uniform();
  normals_[0] = radius * std::sin(angle);
  ready_ = 1;
  return radius * std::cos(angle);
}

double Random::Poisson(double mean) {
  if (mean > kGaussianAbove) return mean + std::sqrt(mean) * Normal();
  // Inversion (Devroye, "Non-uniform random variate generation", 1986, X.3.3): walk up the distribution function.
  const double uniform = Uniform();
  double probability = std::exp(-mean);
  double cumulated = probability;
  double count = 0.0;
  while (uniform > cumulated) {
    count += 1.0;
    probability *= mean / count;
    cumulated += probability;
  }
  return count;
}

}  // namespace merlin
