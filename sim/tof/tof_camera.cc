#include "sim/tof/tof_camera.h"

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "sim/tof/decode.h"
#include "sim/tof/light.h"
#include "sim/tof/normal_row.h"
#include "sim/tof/parallel.h"

namespace merlin::sim {
namespace {

constexpr std::uint16_t kNormals = 1;  // purpose of the Gaussian noise of taps; single electrons use 0

}  // namespace

struct TofCamera::Impl {
  DepthCameraSheet sheet;
  DepthCameraErrors errors;
  TofEffects effects;
  std::uint64_t seed;
  int threads;
  LightModel light;
  Chip chip;
  FixedPattern pattern;
  std::vector<WigglingCorrection> wiggling;  // [frequency of the sheet]; empty: none

  Impl(DepthCameraSheet with_sheet, DepthCameraErrors with_errors, TofEffects with_effects, std::uint64_t with_seed,
       int with_threads)
      : sheet(std::move(with_sheet)),
        errors(with_errors),
        effects(with_effects),
        seed(with_seed),
        threads(with_threads),
        light(sheet, errors, effects, threads),
        chip(sheet, errors, effects),
        pattern(sheet, errors, effects, seed) {
    for (const double frequency_hz : sheet.frequencies_hz)
      if (effects.wiggling && effects.calibrated) wiggling.emplace_back(errors, frequency_hz);
  }

  double Sigma_m(const std::vector<LightImages>& images, std::size_t pixel, const DepthSettings& settings) const;
};

TofCamera::TofCamera(DepthCameraSheet sheet, DepthCameraErrors errors, TofEffects effects, std::uint64_t seed,
                     int threads)
    : impl_(std::make_unique<Impl>(std::move(sheet), errors, effects, seed, threads)) {}
TofCamera::~TofCamera() = default;
TofCamera::TofCamera(TofCamera&&) noexcept = default;

DepthFrame TofCamera::Expose(const TofView& view, const DepthSettings& settings, Time stamp,
                             std::uint64_t index) const {
  const Impl& my = *impl_;
  const Drift drift = DriftAt(my.errors, my.effects, stamp, view.surroundings.temperature_c);
  const std::vector<LightImages> images = my.light.Expose(view, settings, my.pattern, drift);
  const Decoder decoder(my.sheet, settings, my.pattern, my.wiggling, drift);
  DepthFrame frame = decoder.EmptyFrame(stamp, index);
  ParallelFor(frame.height, my.threads, [&](int v) {
    const std::size_t width = static_cast<std::size_t>(frame.width), first = static_cast<std::size_t>(v) * width;
    // One draw serves the four taps of two images.
    std::vector<NormalRow> normals(images.size() / 2, NormalRow(width));
    for (std::size_t draw = 0; draw < normals.size(); ++draw)
      normals[draw].Draw(my.seed, Sensor::kDepth, index, static_cast<std::uint32_t>(first), kNormals,
                         static_cast<std::uint32_t>(draw));
    for (std::size_t pixel = first; pixel < first + width; ++pixel) {
      Random random(my.seed, Sensor::kDepth, index, static_cast<std::uint32_t>(pixel));
      std::array<Taps, 8> taps;
      bool lit = false;
      for (std::size_t k = 0; k < images.size(); ++k) {
        lit |= images[k].lit[pixel] != 0;
        const NormalRow& normal = normals[k / 2];
        random.Give(normal.of[k % 2 * 2][pixel - first], normal.of[k % 2 * 2 + 1][pixel - first]);
        taps[k] = my.chip.Expose({images[k].total_e[pixel], images[k].correlation_e[pixel]}, my.pattern.traits[pixel],
                                 settings.integration_s, random);
      }
      decoder.Decode(std::span<const Taps>(taps).first(images.size()), lit, pixel, frame);
    }
  });
  if (settings.post_processing) PostProcess(frame);
  return frame;
}

// First order: var(phase) = (I^2 var(Q) + Q^2 var(I)) / (I^2 + Q^2)^2, times the slope of the correction. Ranges of two
// frequencies count with their weights.
double TofCamera::Impl::Sigma_m(const std::vector<LightImages>& images, std::size_t pixel,
                                const DepthSettings& settings) const {
  TofEffects mean = effects;
  mean.noise = mean.adc = false;
  const Chip quiet(sheet, errors, mean);
  Random unused(0, Sensor::kDepth, 0);
  double sum = 0.0, weights = 0.0;
  for (std::size_t f = 0; f < images.size() / 4; ++f) {
    std::array<double, 4> D{}, variance{};
    for (std::size_t k = 0; k < 4; ++k) {
      const LightImages& image = images[4 * f + k];
      const Taps taps = quiet.Expose({image.total_e[pixel], image.correlation_e[pixel]}, pattern.traits[pixel],
                                     settings.integration_s, unused);
      D[k] = taps.a_e - taps.b_e;
      variance[k] = chip.DifferenceVariance_e2(taps, settings.integration_s);
    }
    const double I = D[0] - D[2], Q = D[3] - D[1], squared = I * I + Q * Q;
    const double frequency_hz = f == 0 ? settings.frequency_hz : settings.second_frequency_hz;
    const double per_rad_m = kSpeedOfLight_m_s / (4.0 * std::numbers::pi * frequency_hz);
    const double weight = frequency_hz * frequency_hz * squared;
    if (squared <= 0.0) return 0.0;
    const double phase_variance =
        (I * I * (variance[1] + variance[3]) + Q * Q * (variance[0] + variance[2])) / (squared * squared);
    double slope = 1.0;
    for (const WigglingCorrection& correction : wiggling)
      if (correction.frequency_hz() == frequency_hz) slope -= correction.Slope(std::atan2(Q, I));
    sum += std::pow(weight * per_rad_m * slope, 2) * phase_variance;
    weights += weight;
  }
  return std::sqrt(sum) / weights;
}

TofTruth TofCamera::Truth(const TofView& view, const DepthSettings& settings, Time stamp) const {
  const Impl& my = *impl_;
  TofTruth truth;
  truth.width = my.sheet.camera.width;
  truth.height = my.sheet.camera.height;
  for (const SubFrame& sub_frame : my.light.SubFrames(settings))
    truth.T_world_camera.push_back(my.effects.motion ? view.camera.At(sub_frame.Middle_s()) : view.camera.T_world_body);

  DepthSettings plain = settings;
  plain.post_processing = plain.phase_images = false;
  const TofCamera ideal(my.sheet, my.errors, kIdealTof, my.seed, my.threads);
  const DepthFrame reference = ideal.Expose(view, plain, stamp, 0);
  const MidHits middle = TraceMid(view.scene, ideal.impl_->light.optics(), view.camera.T_world_body, my.threads);
  const MidHits whole = TraceMid(view.scene, my.light.optics(), view.camera.T_world_body, my.threads);
  for (std::size_t p = 0; p < middle.hits.size(); ++p) {
    const RayHit& hit = middle.hits[p];
    truth.range_m.push_back(hit.geom < 0 ? 0.0f : hit.range_m);
    truth.depth_m.push_back(truth.range_m.back() * ideal.impl_->light.optics().z[p]);
    truth.geom.push_back(hit.geom);
    truth.material.push_back(hit.geom < 0 ? -1 : view.surroundings.material_id[static_cast<std::size_t>(hit.geom)]);
    truth.mixed.push_back(whole.mixed[p]);
  }
  for (const TofEffectName& effect : TofEffectNames()) {
    TofEffects alone = kIdealTof;
    alone.*(effect.on) = true;
    alone.calibrated = my.effects.calibrated;
    if (!(my.effects.*(effect.on)) || alone.noise || alone.adc || alone.sbi || alone.dead_pixels) continue;
    const DepthFrame frame = TofCamera(my.sheet, my.errors, alone, my.seed, my.threads).Expose(view, plain, stamp, 0);
    TofTruth::Bias bias{std::string(effect.name), {}};
    for (std::size_t p = 0; p < frame.size(); ++p)
      bias.range_m.push_back(static_cast<float>(
          std::remainder(static_cast<double>(frame.range_m[p]) - reference.range_m[p], UnambiguousRange_m(plain))));
    truth.bias.push_back(std::move(bias));
  }
  const Drift drift = DriftAt(my.errors, my.effects, stamp, view.surroundings.temperature_c);
  const std::vector<LightImages> images = my.light.Expose(view, plain, my.pattern, drift);
  for (std::size_t p = 0; p < middle.hits.size(); ++p)
    truth.sigma_m.push_back(static_cast<float>(my.Sigma_m(images, p, plain)));
  return truth;
}

}  // namespace merlin::sim
