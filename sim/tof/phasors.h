// The light of a pixel as phasors: one sum over all the paths on which light reaches it. A pixel that sees two surfaces
// at an edge mixes their phases in this sum, like a real one (flying pixels).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/tof/hits.h"
#include "sim/tof/optics.h"
#include "sim/tof/returns.h"

namespace merlin::sim {

constexpr std::array<int, 3> kHarmonics{1, 3, 5};  // even ones cancel in D_0 - D_2

// Electrons of a sub-frame, and the sum of N_i e^(j n phi_i) over all light paths i, for n of kHarmonics.
struct Phasors {
  float total_e = 0.0f;
  std::array<float, 3> re{}, im{};

  // Adds one light path: its electrons, and the phase of the first harmonic.
  void Add(float electrons, float cosine, float sine);
  // Turns harmonic n by n times this phase.
  void Turn(double phase_rad);
  void Scale(double factor);
  Phasors& operator+=(const Phasors& other);
};

// Factors that turn a hit into electrons: N = scale albedo lit_and_seen cos / d^2.
struct PhasorScale {
  double electrons_m2 = 0.0;         // K T / sub-rays of a pixel
  double wave_number_rad_per_m = 0;  // 4 pi f / c: phase of a range
  std::span<const float> albedo;     // [geom], towards the lamp: above 1 for a retro-reflector
};

// The phasors of one row of pixels as separate arrays, so that the compiler can vectorise over pixels.
struct PhasorRow {
  explicit PhasorRow(std::size_t width);
  std::vector<float> total_e;
  std::array<std::vector<float>, 3> re, im;

  void Clear();
  void Add(std::size_t u, const Phasors& light);
  // Turns harmonic n of pixel u by n times phase_rad[u].
  void Turn(std::span<const float> phase_rad);
  // Re(Z_1 e^(j tau) + a3 Z_3 e^(3 j tau) + a5 Z_5 e^(5 j tau)) times scale, tau = k pi / 2.
  void Correlate(int k, const std::array<float, 3>& weights, float scale, std::span<float> out) const;
};

// Scratch buffers for one row.
struct RowWork {
  RowWork(std::size_t width, std::size_t per_pixel);
  std::vector<float> albedo, electrons, phase, sine, cosine;  // [sub-ray of the row]
  std::array<std::vector<float>, 2> lit;                      // the same, by board
};

// shadow: [sub-ray] bit b is set if the light of board b does not reach what that sub-ray hit at mid-exposure; empty:
// no shadows. extra: the further returns of this row.
void RowPhasors(const RowHits& hits, const Optics& optics, const PhasorScale& scale, const MidHits& mid,
                std::span<const std::uint8_t> shadow, std::span<const ExtraReturn> extra, int row, RowWork& work,
                PhasorRow& out);

}  // namespace merlin::sim
