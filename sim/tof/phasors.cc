#include "sim/tof/phasors.h"

#include <algorithm>
#include <cmath>

#include "sim/tof/lanes.h"
#include "sim/tof/sin_cos.h"

namespace merlin::sim {
namespace {

constexpr float kNearest_m = 1e-3f;  // no surface is nearer than the lens; keeps 1 / d^2 finite

using In = const float*;
using Out = float*;

inline float Larger(float a, float b) {
  return a > b ? a : b;
}  // by value: std::max returns a reference, which keeps the compiler from vectorising

void GatherAlbedo(const RowHits& hits, const PhasorScale& scale, RowWork& work) {
  for (std::size_t i = 0; i < hits.geom.size(); ++i)
    work.albedo[i] = hits.geom[i] >= 0 ? scale.albedo[static_cast<std::size_t>(hits.geom[i])] : 0.0f;
}

// Light of a lamp at the lens.
void LightFromLens(const RowHits& hits, const Optics& optics, std::size_t first, float scale, float wave_number,
                   RowWork& work) {
  const In dx = optics.x.data() + first, dy = optics.y.data() + first, dz = optics.z.data() + first;
  const In seen = optics.lit_and_seen.data() + first, albedo = work.albedo.data(), range_m = hits.range_m.data();
  const In nx = hits.normal_x.data(), ny = hits.normal_y.data(), nz = hits.normal_z.data();
  const Out electrons = work.electrons.data(), phase = work.phase.data();
  const std::size_t count = hits.geom.size();
  MERLIN_SIDE_BY_SIDE
  for (std::size_t i = 0; i < count; ++i) {
    const float range = Larger(range_m[i], kNearest_m);
    const float toward = nx[i] * dx[i] + ny[i] * dy[i] + nz[i] * dz[i];
    electrons[i] = scale * albedo[i] * seen[i] * Larger(-toward, 0.0f) / (range * range);
    phase[i] = wave_number * range_m[i];
  }
}

// Light of boards beside the lens, on the weighted mean of their paths. To second order in the difference this equals
// the sum of two phasors.
void LightFromBoards(const RowHits& hits, const Optics& optics, std::size_t first, float scale, float wave_number,
                     RowWork& work) {
  const In dx = optics.x.data() + first, dy = optics.y.data() + first, dz = optics.z.data() + first;
  const In seen = optics.lit_and_seen.data() + first, albedo = work.albedo.data(), range_m = hits.range_m.data();
  const In nx = hits.normal_x.data(), ny = hits.normal_y.data(), nz = hits.normal_z.data();
  const Out electrons = work.electrons.data(), phase = work.phase.data();
  const std::size_t count = hits.geom.size();
  const In lit_left = work.lit[0].data(), lit_right = work.lit[1].data();
  const float board_x = optics.boards[1].position.x();
  MERLIN_SIDE_BY_SIDE
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
    const float from_board_m = 0.25f * (from_left * left + from_right * right) / Larger(both, 1e-30f);
    electrons[i] = scale * albedo[i] * seen[i] * both;
    phase[i] = wave_number * (0.5f * range + from_board_m);
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
              std::size_t first, PhasorRow& out) {
  const std::size_t i = extra.sub_ray - first;
  if (hits.geom[i] != extra.geom) return;  // the pane is no longer in this sub-ray
  const double range_m = std::max(hits.range_m[i], kNearest_m) + extra.beyond_m;
  const double phase_rad = scale.wave_number_rad_per_m * range_m;
  const double electrons =
      scale.electrons_m2 * extra.strength * optics.lit_and_seen[extra.sub_ray] / (range_m * range_m);
  Phasors light;
  light.Add(static_cast<float>(electrons), static_cast<float>(std::cos(phase_rad)),
            static_cast<float>(std::sin(phase_rad)));
  out.Add(i % static_cast<std::size_t>(optics.width), light);
}

// Adds one light path to each of width pixels: electrons, cosine and sine of the first harmonic's phase.
void AddWays(In electrons, In cosine, In sine, std::size_t width, PhasorRow& out) {
  const Out total_e = out.total_e.data();
  const Out re1 = out.re[0].data(), re3 = out.re[1].data(), re5 = out.re[2].data();
  const Out im1 = out.im[0].data(), im3 = out.im[1].data(), im5 = out.im[2].data();
  MERLIN_SIDE_BY_SIDE
  for (std::size_t u = 0; u < width; ++u) {
    const float e = electrons[u], c = cosine[u], s = sine[u];
    const float c2 = c * c - s * s, s2 = 2.0f * c * s;
    const float c3 = c2 * c - s2 * s, s3 = s2 * c + c2 * s;
    const float c5 = c3 * c2 - s3 * s2, s5 = s3 * c2 + c3 * s2;
    total_e[u] += e;
    re1[u] += e * c, re3[u] += e * c3, re5[u] += e * c5;
    im1[u] += e * s, im3[u] += e * s3, im5[u] += e * s5;
  }
}

void Rotate(Out re, Out im, In cosine, In sine, std::size_t width) {
  MERLIN_SIDE_BY_SIDE
  for (std::size_t u = 0; u < width; ++u) {
    const float turned = re[u] * cosine[u] - im[u] * sine[u];
    im[u] = re[u] * sine[u] + im[u] * cosine[u];
    re[u] = turned;
  }
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

PhasorRow::PhasorRow(std::size_t width) : total_e(width) {
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) re[h].resize(width), im[h].resize(width);
}

void PhasorRow::Clear() {
  std::ranges::fill(total_e, 0.0f);
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) std::ranges::fill(re[h], 0.0f), std::ranges::fill(im[h], 0.0f);
}

void PhasorRow::Add(std::size_t u, const Phasors& light) {
  total_e[u] += light.total_e;
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) re[h][u] += light.re[h], im[h][u] += light.im[h];
}

void PhasorRow::Turn(std::span<const float> phase_rad) {
  const std::size_t width = phase_rad.size();
  std::vector<float> sine(width), cosine(width), sine_n(width), cosine_n(width), ones(width, 1.0f);
  SinCos(phase_rad, sine, cosine);
  PhasorRow turn(width);
  AddWays(ones.data(), cosine.data(), sine.data(), width, turn);
  for (std::size_t h = 0; h < kHarmonics.size(); ++h)
    Rotate(re[h].data(), im[h].data(), turn.re[h].data(), turn.im[h].data(), width);
}

void PhasorRow::Correlate(int k, const std::array<float, 3>& weights, float scale, std::span<float> out) const {
  std::ranges::fill(out, 0.0f);
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) {
    const int quarter = kHarmonics[h] * k % 4;  // Re(Z i^quarter)
    const In part = quarter % 2 == 0 ? re[h].data() : im[h].data();
    const float weight = scale * weights[h] * (quarter == 1 || quarter == 2 ? -1.0f : 1.0f);
    const Out sum = out.data();
    MERLIN_SIDE_BY_SIDE
    for (std::size_t u = 0; u < out.size(); ++u) sum[u] += weight * part[u];
  }
}

RowWork::RowWork(std::size_t width, std::size_t per_pixel) {
  for (auto* values : {&albedo, &electrons, &phase, &lit[0], &lit[1], &sine, &cosine})
    values->resize(width * per_pixel);
}

void RowPhasors(const RowHits& hits, const Optics& optics, const PhasorScale& scale, const MidHits& mid,
                std::span<const std::uint8_t> shadow, std::span<const ExtraReturn> extra, int row, RowWork& work,
                PhasorRow& out) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel), width = static_cast<std::size_t>(optics.width);
  const std::size_t first = static_cast<std::size_t>(row) * width * n;
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
  out.Clear();
  for (std::size_t s = 0; s < n; ++s)
    AddWays(work.electrons.data() + s * width, work.cosine.data() + s * width, work.sine.data() + s * width, width,
            out);
  for (const ExtraReturn& one : extra) AddExtra(hits, optics, scale, one, first, out);
}

}  // namespace merlin::sim
