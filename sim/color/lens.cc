#include "sim/color/lens.h"

#ifdef __SSE4_1__
#include <immintrin.h>
#endif

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace merlin::sim {
namespace {

// For each pixel of the camera the position, along the same ray, in a pinhole picture with the same focal lengths and
// principal point.
std::vector<Eigen::Vector2d> UndistortedPixels(const CameraModel& camera) {
  std::vector<Eigen::Vector2d> pixels;
  pixels.reserve(static_cast<std::size_t>(camera.width) * camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d xy =
          camera.Undistort({(u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px});
      pixels.emplace_back(camera.fx_px * xy.x() + camera.cx_px, camera.fy_px * xy.y() + camera.cy_px);
    }
  return pixels;
}

// Bilinear mean of four neighbouring BGR pixels, rounded. right_256, down_256: weights of the right and lower ones.
void Blend(const std::uint8_t* upper, const std::uint8_t* lower, int right_256, int down_256, std::uint8_t* out) {
  for (int c = 0; c < 3; ++c) {
    const int above = 256 * upper[c] + right_256 * (upper[c + 3] - upper[c]);
    const int below = 256 * lower[c] + right_256 * (lower[c + 3] - lower[c]);
    out[c] = static_cast<std::uint8_t>((256 * above + down_256 * (below - above) + 0x8000) >> 16);
  }
}

// The same with SIMD instructions. Reads eight bytes of each row and writes four.
void BlendAtOnce(const std::uint8_t* upper, const std::uint8_t* lower, int right_256, int down_256, std::uint8_t* out) {
#ifdef __SSE4_1__
  // b b' g g' r r' as 16-bit numbers: left and right pixel side by side, for one multiply and add.
  const __m128i pair = _mm_setr_epi8(0, -1, 3, -1, 1, -1, 4, -1, 2, -1, 5, -1, -1, -1, -1, -1);
  const __m128i across = _mm_set1_epi32((256 - right_256) | right_256 << 16);
  const auto row = [&](const std::uint8_t* from) {
    return _mm_madd_epi16(_mm_shuffle_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)), pair), across);
  };
  const __m128i above = _mm_mullo_epi32(row(upper), _mm_set1_epi32(256 - down_256));
  const __m128i below = _mm_mullo_epi32(row(lower), _mm_set1_epi32(down_256));
  const __m128i sum = _mm_add_epi32(_mm_add_epi32(above, below), _mm_set1_epi32(0x8000));
  const __m128i third_byte = _mm_setr_epi8(2, 6, 10, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
  const int bgr = _mm_cvtsi128_si32(_mm_shuffle_epi8(sum, third_byte));
  std::memcpy(out, &bgr, 4);
#else
  Blend(upper, lower, right_256, down_256, out);
#endif
}

}  // namespace

Lens::Lens(const CameraModel& camera) : pinhole_(camera) {
  if (!camera.Distorts()) return;
  const std::vector<Eigen::Vector2d> pixels = UndistortedPixels(camera);
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector2d& pixel : pixels) extent.extend(pixel);
  const Eigen::Vector2d first(std::floor(extent.min().x()), std::floor(extent.min().y()));
  pinhole_ = {.width = static_cast<int>(extent.max().x() - first.x()) + 2,
              .height = static_cast<int>(extent.max().y() - first.y()) + 2,
              .fx_px = camera.fx_px,
              .fy_px = camera.fy_px,
              .cx_px = camera.cx_px - first.x(),
              .cy_px = camera.cy_px - first.y()};
  for (const Eigen::Vector2d& pixel : pixels) {
    // Pixel index and weight in one number. The index stays below the last column, so that there is a right neighbour.
    const auto u_256 = static_cast<std::uint32_t>(std::lround(256.0 * (pixel.x() - first.x())));
    const auto v_256 = static_cast<std::uint32_t>(std::lround(256.0 * (pixel.y() - first.y())));
    const std::uint32_t u = std::min<std::uint32_t>(u_256 / 256, pinhole_.width - 2);
    const std::uint32_t v = std::min<std::uint32_t>(v_256 / 256, pinhole_.height - 2);
    places_.push_back({3 * (v * pinhole_.width + u), static_cast<std::uint16_t>(u_256 - 256 * u),
                       static_cast<std::uint16_t>(v_256 - 256 * v)});
  }
}

void Lens::Remap(std::span<const std::uint8_t> pinhole_bgr, std::span<std::uint8_t> bgr) const {
  assert(pinhole_bgr.size() == 3 * static_cast<std::size_t>(pinhole_.width) * pinhole_.height);
  if (places_.empty()) {
    std::copy(pinhole_bgr.begin(), pinhole_bgr.end(), bgr.begin());
    return;
  }
  assert(bgr.size() == 3 * places_.size());
  const std::size_t row = 3 * static_cast<std::size_t>(pinhole_.width);
  std::uint8_t* out = bgr.data();
  const std::uint8_t* const end = pinhole_bgr.data() + pinhole_bgr.size();
  for (const Place& place : places_) {
    const std::uint8_t* upper = pinhole_bgr.data() + place.first;
    if (upper + row + 8 <= end && &place != &places_.back())
      BlendAtOnce(upper, upper + row, place.right_256, place.down_256, out);
    else
      Blend(upper, upper + row, place.right_256, place.down_256, out);
    out += 3;
  }
}

}  // namespace merlin::sim
