#include "sim/color/color_response.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "robot/base/random.h"

namespace merlin::sim {
namespace {

constexpr int kSteps = 4096;  // of the 12-bit converter

// 2^12 equally likely values of the standard normal distribution (reaching +-3.7 sigma), scaled to variance 1.
constexpr int kQuantileBits = 12;
constexpr int kQuantiles = 1 << kQuantileBits;

// x with Phi(x) = p for p in [0.5, 1). Newton's method from x = 0: Phi is concave there, so no step overshoots.
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

// out[i] = table[index[i]], eight at a time with AVX2.
template <std::size_t kCount>
void LookUp(const float* table, const std::array<int, kCount>& index, float* out) {
#ifdef __AVX2__
  static_assert(kCount % 8 == 0);
  for (std::size_t i = 0; i < kCount; i += 8)
    _mm256_storeu_ps(out + i,
                     _mm256_i32gather_ps(table, _mm256_load_si256(reinterpret_cast<const __m256i*>(&index[i])), 4));
#else
  for (std::size_t i = 0; i < kCount; ++i) out[i] = table[index[i]];
#endif
}

std::array<std::uint8_t, kSteps> CodeTable() {
  std::array<std::uint8_t, kSteps> table{};
  for (int i = 0; i < kSteps; ++i) table[i] = static_cast<std::uint8_t>(SrgbOfLinear(i / (kSteps - 1.0)) + 0.5);
  return table;
}

// Vignetting factor for every value of a picture, followed by padding zeros.
std::vector<float> Falloff(const CameraModel& camera, double power, std::size_t padding) {
  std::vector<float> falloff;
  falloff.reserve(3 * static_cast<std::size_t>(camera.width) * camera.height + padding);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      falloff.insert(falloff.end(), 3, static_cast<float>(std::pow(camera.Ray(u, v).z(), power)));
  falloff.insert(falloff.end(), padding, 0.0f);
  return falloff;
}

}  // namespace

double LinearOfSrgb(double value) {
  const double code = value / 255.0;
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double SrgbOfLinear(double light) {
  return 255.0 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055);
}

ColorResponse::ColorResponse(const ColorCameraSheet& sheet, std::uint64_t seed)
    : sheet_(sheet), seed_(seed), falloff_(Falloff(sheet.camera, sheet.falloff_power, kChunk)) {}

// Factors and tables that depend on the settings of a picture.
struct ColorResponse::Scale {
  std::array<float, 256> light_wells{};        // for each rendered value: electrons on the axis, in full wells
  std::array<float, kChunk> steps_per_well{};  // for channels b, g, r, b, ...
  float shot_variance_wells = 0.0f;            // for one full well of light
  float read_variance_wells = 0.0f;
};

ColorResponse::Scale ColorResponse::ScaleOf(const ColorSettings& settings) const {
  Scale scale;
  for (int value = 0; value < 256; ++value)
    scale.light_wells[value] =
        static_cast<float>(LinearOfSrgb(value) * settings.exposure_s / sheet_.exposure_nominal_s);
  const std::array<double, 3> balance{settings.white_balance_blue, 1.0, settings.white_balance_red};
  for (int i = 0; i < kChunk; ++i)
    scale.steps_per_well[i] = static_cast<float>((kSteps - 1) * settings.gain * balance[i % 3]);
  scale.shot_variance_wells = static_cast<float>(1.0 / sheet_.full_well_e);
  scale.read_variance_wells = static_cast<float>(std::pow(sheet_.read_noise_e / sheet_.full_well_e, 2.0));
  return scale;
}

void ColorResponse::ExposeChunk(std::span<std::uint8_t, kChunk> values, std::size_t first, const Scale& scale,
                                const std::array<float, kChunk>& deviate) const {
  static const std::array<std::uint8_t, kSteps> code = CodeTable();
  const float *falloff = &falloff_[first], *steps_per_well = scale.steps_per_well.data();
  alignas(32) std::array<float, kChunk> wells;
  alignas(32) std::array<int, kChunk> step;
  for (std::size_t i = 0; i < kChunk; ++i) step[i] = values[i];
  LookUp(scale.light_wells.data(), step, wells.data());
  for (std::size_t i = 0; i < kChunk; ++i) {
    const float mean = wells[i] * falloff[i];
    const float sigma = std::sqrt(mean * scale.shot_variance_wells + scale.read_variance_wells);
    const float clipped = std::min(mean + sigma * deviate[i], 1.0f);
    step[i] = static_cast<int>(std::clamp(clipped * steps_per_well[i] + 0.5f, 0.0f, kSteps - 1.0f));
  }
  for (std::size_t i = 0; i < kChunk; ++i) values[i] = code[static_cast<std::size_t>(step[i])];
}

void ColorResponse::Expose(std::span<std::uint8_t> bgr, const ColorSettings& settings, std::uint64_t frame) const {
  assert(bgr.size() + kChunk <= falloff_.size());
  static const std::array<float, kQuantiles> normal = NormalTable();
  const Scale scale = ScaleOf(settings);
  const std::array<std::uint32_t, 2> key{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)};
  // Counter as in robot/base/random.h; eight blocks give 16 bits each to 64 neighbouring values.
  const std::uint32_t purpose = static_cast<std::uint32_t>(Sensor::kColor) << 8 | (frame >> 32 & 0xFF);
  for (std::size_t first = 0; first < bgr.size(); first += kChunk) {
    alignas(32) std::array<float, kChunk> deviate;
    for (std::size_t part = 0; part < kChunk; part += 64) {
      const auto block = static_cast<std::uint32_t>((first + part) / 8);
      const PhiloxOctet random = Philox4x32Octet({0, block, static_cast<std::uint32_t>(frame), purpose}, key);
      alignas(32) std::array<int, 64> index;
      for (std::size_t word = 0; word < 4; ++word)
        for (std::size_t i = 0; i < 8; ++i) {
          index[16 * word + i] = static_cast<int>(random[word][i] >> 16 >> (16 - kQuantileBits));
          index[16 * word + 8 + i] = static_cast<int>((random[word][i] & 0xFFFF) >> (16 - kQuantileBits));
        }
      LookUp(normal.data(), index, deviate.data() + part);
    }
    if (bgr.size() - first >= kChunk) {
      ExposeChunk(bgr.subspan(first).first<kChunk>(), first, scale, deviate);
    } else {
      std::array<std::uint8_t, kChunk> last{};
      std::copy(bgr.begin() + first, bgr.end(), last.begin());
      ExposeChunk(last, first, scale, deviate);
      std::copy(last.begin(), last.begin() + (bgr.size() - first), bgr.begin() + first);
    }
  }
}

ColorSettings NextExposure(const ColorCameraSheet& sheet, const ColorSettings& settings,
                           std::span<const std::uint8_t> bgr) {
  constexpr double kGreyCard = 0.18;
  constexpr std::size_t kEvery = 31;  // every 31st value is enough for the mean
  std::array<double, 256> light{};
  for (int value = 0; value < 256; ++value) light[value] = LinearOfSrgb(value);
  std::array<std::uint32_t, 256> histogram{};
  for (std::size_t i = 0; i < bgr.size(); i += kEvery) ++histogram[bgr[i]];
  double sum = 0.0, count = 0.0;
  for (std::size_t value = 0; value < 256; ++value) sum += histogram[value] * light[value], count += histogram[value];
  const double missing_stops = std::log2(kGreyCard / std::max(sum / count, 1e-4));
  if (std::abs(missing_stops) < 0.25) return settings;
  const double wanted_s = settings.exposure_s * settings.gain * std::exp2(0.5 * missing_stops);
  ColorSettings next = settings;
  next.exposure_s = std::clamp(wanted_s, sheet.exposure_min_s, sheet.exposure_max_s);
  next.gain = std::clamp(wanted_s / next.exposure_s, 1.0, sheet.gain_max);
  return next;
}

}  // namespace merlin::sim
