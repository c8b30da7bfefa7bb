// Counter-based random numbers: Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
// A draw is a pure function of (seed, sensor, frame, pixel, purpose, draw): no state, any order, any thread count, and
// switching one sensor off changes no other's noise.
#pragma once

#include <array>
#include <cstdint>

namespace merlin {

// The block function itself, as Random123 defines it.
std::array<std::uint32_t, 4> Philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

// Eight blocks at once: for this counter and for the seven that follow it in counter[1]. Indexed [word][block]. Several
// times as fast as eight calls of Philox4x32.
using PhiloxOctet = std::array<std::array<std::uint32_t, 8>, 4>;
PhiloxOctet Philox4x32Octet(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

enum class Sensor : std::uint32_t { kDepth = 1, kColor = 2, kCompass = 3, kDrive = 4 };

// The stream of one pixel (or one reading) of one frame of one sensor. frame < 2^40 (348 years at 100 Hz); 2^34 draws.
class Random {
 public:
  Random(std::uint64_t seed, Sensor sensor, std::uint64_t frame, std::uint32_t pixel = 0, std::uint16_t purpose = 0);
  double Uniform();  // (0, 1), in steps of 2^-32
  double Normal();   // mean 0, sigma 1
  // Makes the next two calls of Normal return these numbers, which were drawn elsewhere: first, then second.
  void Give(float first, float second) { normals_ = {second, first}, ready_ = 2; }
  double Poisson(double mean);  // mean >= 0; a Gaussian of the same variance above 50

 private:
  std::array<std::uint32_t, 4>
      counter_;  // block, pixel, frame's low 32 bits, purpose (16) | sensor (8) | frame's high 8
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
  std::array<double, 2> normals_{};  // drawn and not yet returned; normals_[ready_ - 1] is next
  int ready_ = 0;
};

}  // namespace merlin
