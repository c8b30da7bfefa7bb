#include "sim/random.h"

#include <cmath>
#include <numbers>

namespace merlin::sim {
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

std::array<std::array<std::uint32_t, 4>, 4> Philox4x32Quad(std::array<std::uint32_t, 4> counter,
                                                           std::array<std::uint32_t, 2> key) {
  std::array<std::array<std::uint32_t, 4>, 4> words;  // [word][block]: the compiler puts the blocks side by side
  for (std::uint32_t block = 0; block < 4; ++block)
    for (int word = 0; word < 4; ++word) words[word][block] = counter[word] + (word == 1 ? block : 0);
  for (int round = 0; round < kRounds; ++round) {
    for (int block = 0; block < 4; ++block) {
      const std::uint64_t product0 = std::uint64_t{kMultiplier0} * words[0][block];
      const std::uint64_t product1 = std::uint64_t{kMultiplier1} * words[2][block];
      const std::uint32_t word1 = words[1][block], word3 = words[3][block];
      words[0][block] = static_cast<std::uint32_t>(product1 >> 32) ^ word1 ^ key[0];
      words[1][block] = static_cast<std::uint32_t>(product1);
      words[2][block] = static_cast<std::uint32_t>(product0 >> 32) ^ word3 ^ key[1];
      words[3][block] = static_cast<std::uint32_t>(product0);
    }
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  std::array<std::array<std::uint32_t, 4>, 4> blocks;
  for (int block = 0; block < 4; ++block)
    for (int word = 0; word < 4; ++word) blocks[block][word] = words[word][block];
  return blocks;
}

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
  if (has_spare_) {
    has_spare_ = false;
    return spare_normal_;
  }
  // Box and Muller, "A note on the generation of random normal deviates", Ann. Math. Stat. 29 (1958). |value| < 6.7.
  const double radius = std::sqrt(-2.0 * std::log(Uniform()));
  const double angle = 2.0 * std::numbers::pi * Uniform();
  spare_normal_ = radius * std::sin(angle);
  has_spare_ = true;
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

}  // namespace merlin::sim
