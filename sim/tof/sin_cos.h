// Sine and cosine of many phases at once.
#pragma once

#include <cstddef>
#include <numbers>
#include <span>

namespace merlin::sim {

// Sine and cosine of many phases: Cody and Waite's reduction to [-pi/4, pi/4] and the minimax polynomials of Cephes
// (Moshier, sinf and cosf), without branches, so that the compiler does several at a time. |phase| < 1e4; error < 1e-6.
inline void SinCos(std::span<const float> phase, std::span<float> sine, std::span<float> cosine) {
  constexpr float kRounder = 12582912.0f;  // 1.5 * 2^23: adding and taking it away rounds to a whole number
  constexpr float kHalfPi1 = 1.5703125f, kHalfPi2 = 4.837512969970703125e-4f, kHalfPi3 = 7.549789948768648e-8f;
  for (std::size_t i = 0; i < phase.size(); ++i) {
    const float x = phase[i];
    const float whole = (x * static_cast<float>(2.0 / std::numbers::pi) + kRounder) - kRounder;
    const int quadrant = static_cast<int>(whole);
    const float r = ((x - whole * kHalfPi1) - whole * kHalfPi2) - whole * kHalfPi3;
    const float z = r * r;
    const float s = r + r * z * (-1.6666654611e-1f + z * (8.3321608736e-3f - z * 1.9515295891e-4f));
    const float c =
        1.0f - 0.5f * z + z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + z * 2.443315711809948e-5f));
    const float sine_part = (quadrant & 1) ? c : s, cosine_part = (quadrant & 1) ? s : c;
    sine[i] = (quadrant & 2) ? -sine_part : sine_part;
    cosine[i] = ((quadrant + 1) & 2) ? -cosine_part : cosine_part;
  }
}

}  // namespace merlin::sim
