#include "sim/tof/phasors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin::sim {
namespace {

constexpr float kNearest_m = 1e-3f;  // nothing is nearer to the pixel than its lens: keeps 1 / d^2 finite

// Sine and cosine of many phases: Cody and Waite's reduction to [-pi/4, pi/4] and the minimax polynomials of Cephes
// (Moshier, sinf and cosf), without branches, so that the compiler does several at a time. |phase| < 1e4; error < 1e-6.
void SinCos(std::span<const float> phase, std::span<float> sine, std::span<float> cosine) {
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

// Arrays that do not overlap, so that the compiler does several elements at a time.
using In = const float* __restrict;
using Out = float* __restrict;

inline float Larger(float a, float b) { return a > b ? a : b; }  // by value: std::max's references stand in the way

// The sub-rays of a row as the sums need them.
struct RowWork {
  std::vector<float> albedo, electrons, phase, sine, cosine;
  std::array<std::vector<float>, 2> lit;  // by board
  explicit RowWork(std::size_t n) : albedo(n), electrons(n), phase(n), sine(n), cosine(n) {
    for (auto& of_board : lit) of_board.resize(n);
  }
};

void GatherAlbedo(const RowHits& hits, const PhasorScale& scale, RowWork& work) {
  for (std::size_t i = 0; i < hits.geom.size(); ++i)
    work.albedo[i] = hits.geom[i] >= 0 ? scale.albedo[static_cast<std::size_t>(hits.geom[i])] : 0.0f;
}

// A lamp at the lens.
void LightFromLens(const RowHits& hits, const Optics& optics, std::size_t first, float scale, float wave_number,
                   RowWork& work) {
  const In dx = optics.x.data() + first, dy = optics.y.data() + first, dz = optics.z.data() + first;
  const In seen = optics.lit_and_seen.data() + first, albedo = work.albedo.data(), range_m = hits.range_m.data();
  const In nx = hits.normal_x.data(), ny = hits.normal_y.data(), nz = hits.normal_z.data();
  const Out electrons = work.electrons.data(), phase = work.phase.data();
  const std::size_t count = hits.geom.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float range = Larger(range_m[i], kNearest_m);
    const float toward = nx[i] * dx[i] + ny[i] * dy[i] + nz[i] * dz[i];
    electrons[i] = scale * albedo[i] * seen[i] * Larger(-toward, 0.0f) / (range * range);
    phase[i] = wave_number * range_m[i];
  }
}

// Boards beside it: the way of their light is their mean, weighted: to second order in the difference what two phasors
// would give.
void LightFromBoards(const RowHits& hits, const Optics& optics, std::size_t first, float scale, float wave_number,
                     RowWork& work) {
  const In dx = optics.x.data() + first, dy = optics.y.data() + first, dz = optics.z.data() + first;
  const In seen = optics.lit_and_seen.data() + first, albedo = work.albedo.data(), range_m = hits.range_m.data();
  const In nx = hits.normal_x.data(), ny = hits.normal_y.data(), nz = hits.normal_z.data();
  const Out electrons = work.electrons.data(), phase = work.phase.data();
  const std::size_t count = hits.geom.size();
  const In lit_left = work.lit[0].data(), lit_right = work.lit[1].data();
  const float board_x = optics.boards[1].position.x();
  for (std::size_t i = 0; i < count; ++i) {
    const float range = Larger(range_m[i], kNearest_m);
    const float x = range * dx[i], y = range * dy[i], z = range * dz[i];
    const float in_y_and_z = ny[i] * y + nz[i] * z;
    const float left_x = x + board_x, right_x = x - board_x;
    const float left_2 = left_x * left_x + y * y + z * z, right_2 = right_x * right_x + y * y + z * z;
    const float left = std::sqrt(left_2), right = std::sqrt(right_2);
    const float from_left = lit_left[i] * Larger(-(nx[i] * left_x + in_y_and_z), 0.0f) / (left * left_2);
    const float from_right = lit_right[i] * Larger(-(nx[i] * right_x + in_y_and_z), 0.0f) / (right * right_2);
    const float both = 0.5f * (from_left + from_right);
    const float way = 0.25f * (from_left * left + from_right * right) / Larger(both, 1e-30f);
    electrons[i] = scale * albedo[i] * seen[i] * both;
    phase[i] = wave_number * (0.5f * range + way);
  }
}

void GatherShadows(const RowHits& hits, const MidHits& mid, std::span<const std::uint8_t> shadow, std::size_t first,
                   RowWork& work) {
  for (std::size_t i = 0; i < hits.geom.size(); ++i) {
    const std::uint8_t bits =
        !shadow.empty() && mid.hits[first + i].geom == hits.geom[i] ? shadow[first + i] : std::uint8_t{0};
    work.lit[0][i] = (bits & 1) ? 0.0f : 1.0f;
    work.lit[1][i] = (bits & 2) ? 0.0f : 1.0f;
  }
}

void AddExtra(const RowHits& hits, const Optics& optics, const PhasorScale& scale, const ExtraReturn& extra,
              std::size_t first, std::span<Phasors> out) {
  const std::size_t i = extra.sub_ray - first;
  if (hits.geom[i] != extra.geom) return;  // the pane has moved out of this sub-ray
  const double range_m = std::max(hits.range_m[i], kNearest_m) + extra.beyond_m;
  const double phase_rad = scale.wave_number_rad_per_m * range_m;
  const double electrons =
      scale.electrons_m2 * extra.strength * optics.lit_and_seen[extra.sub_ray] / (range_m * range_m);
  out[i / static_cast<std::size_t>(optics.per_pixel)].Add(
      static_cast<float>(electrons), static_cast<float>(std::cos(phase_rad)), static_cast<float>(std::sin(phase_rad)));
}

}  // namespace

void Phasors::Add(float electrons, float c, float s) {
  const float c2 = c * c - s * s, s2 = 2.0f * c * s;
  const float c3 = c2 * c - s2 * s, s3 = s2 * c + c2 * s;
  const float c5 = c3 * c2 - s3 * s2, s5 = s3 * c2 + c3 * s2;
  total_e += electrons;
  re[0] += electrons * c, re[1] += electrons * c3, re[2] += electrons * c5;
  im[0] += electrons * s, im[1] += electrons * s3, im[2] += electrons * s5;
}

void Phasors::Turn(double phase_rad) {
  const float c = static_cast<float>(std::cos(phase_rad)), s = static_cast<float>(std::sin(phase_rad));
  Phasors turn;
  turn.Add(1.0f, c, s);
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) {
    const float turned = re[h] * turn.re[h] - im[h] * turn.im[h];
    im[h] = re[h] * turn.im[h] + im[h] * turn.re[h];
    re[h] = turned;
  }
}

void Phasors::Scale(double factor) {
  const float f = static_cast<float>(factor);
  total_e *= f;
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) re[h] *= f, im[h] *= f;
}

Phasors& Phasors::operator+=(const Phasors& other) {
  total_e += other.total_e;
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) re[h] += other.re[h], im[h] += other.im[h];
  return *this;
}

double Correlate(const Phasors& light, int k, double a3, double a5) {
  const std::array<double, 3> weight{1.0, a3, a5};
  double sum = 0.0;
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) {
    switch (kHarmonics[h] * k % 4) {  // Re(Z i^(n k))
      case 0:
        sum += weight[h] * light.re[h];
        break;
      case 1:
        sum -= weight[h] * light.im[h];
        break;
      case 2:
        sum -= weight[h] * light.re[h];
        break;
      default:
        sum += weight[h] * light.im[h];
    }
  }
  return sum;
}

void RowPhasors(const RowHits& hits, const Optics& optics, const PhasorScale& scale, const MidHits& mid,
                std::span<const std::uint8_t> shadow, std::span<const ExtraReturn> extra, int row,
                std::span<Phasors> out) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel);
  const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(optics.width) * n;
  RowWork work(hits.geom.size());
  GatherAlbedo(hits, scale, work);
  const float electrons_m2 = static_cast<float>(scale.electrons_m2);
  const float wave_number = static_cast<float>(scale.wave_number_rad_per_m);
  if (optics.boards.size() == 2) {
    GatherShadows(hits, mid, shadow, first, work);
    LightFromBoards(hits, optics, first, electrons_m2, wave_number, work);
  } else {
    LightFromLens(hits, optics, first, electrons_m2, wave_number, work);
  }
  SinCos(work.phase, work.sine, work.cosine);
  for (std::size_t u = 0; u < out.size(); ++u) {
    out[u] = {};
    for (std::size_t i = u * n; i < (u + 1) * n; ++i) out[u].Add(work.electrons[i], work.cosine[i], work.sine[i]);
  }
  for (const ExtraReturn& one : extra) AddExtra(hits, optics, scale, one, first, out);
}

}  // namespace merlin::sim
