#include "sim/tof/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/parallel.h"

namespace merlin::sim {
namespace {

double WaveNumber(double frequency_hz) { return 4.0 * std::numbers::pi * frequency_hz / kSpeedOfLight_m_s; }

}  // namespace

LightModel::LightModel(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects,
                       int threads)
    : sheet_(sheet),
      errors_(errors),
      effects_(effects),
      threads_(threads),
      optics_(sheet, errors, effects),
      scatter_(sheet.camera.width, sheet.camera.height, errors) {}

std::vector<SubFrame> LightModel::SubFrames(const DepthSettings& settings) const {
  const double span_s = sheet_.ExposureSpan_s(settings);
  std::vector<SubFrame> sub_frames;
  for (int k = 0; k < settings.sub_frames(); ++k)
    sub_frames.push_back({.begin_s = -0.5 * span_s + k * (settings.integration_s + sheet_.readout_s),
                          .integration_s = settings.integration_s});
  return sub_frames;
}

bool LightModel::Moves(const TofView& view) const {
  const auto moves = [](const BodyMotion& body) { return !body.still(); };
  return effects_.motion && (moves(view.camera) || std::ranges::any_of(view.bodies, moves));
}

bool LightModel::MayReuse(const TofView& view, const MidHits& mid, const DepthSettings& settings) const {
  float nearest_m = 100.0f;
  for (const RayHit& hit : mid.hits)
    if (hit.geom >= 0) nearest_m = std::min(nearest_m, hit.range_m);
  return std::ranges::all_of(view.bodies, &BodyMotion::still) &&
         PictureMotion_px(optics_, view.camera, sheet_.ExposureSpan_s(settings), nearest_m) < 1.0;
}

LightModel::Still LightModel::TakeStill(const TofView& view) const {
  Still still;
  still.mid = TraceMid(view.scene, optics_, view.camera.T_world_body, threads_);
  still.lamp_albedo = LampAlbedos(view.surroundings, effects_);
  if (effects_.glass || effects_.specular)
    still.extra = TraceReturns(view.scene, view.surroundings, optics_, still.mid, errors_, effects_);
  const std::size_t row_rays = static_cast<std::size_t>(optics_.width) * static_cast<std::size_t>(optics_.per_pixel);
  for (std::size_t row = 0; row <= static_cast<std::size_t>(optics_.height); ++row)
    still.extra_from.push_back(static_cast<std::size_t>(
        std::ranges::lower_bound(still.extra, row * row_rays, {}, &ExtraReturn::sub_ray) - still.extra.begin()));
  if (optics_.boards.size() > 1) still.shadow = LampShadows(view.scene, optics_, still.mid, threads_);
  if (effects_.sunlight && (view.surroundings.sun || view.surroundings.ambient_w_m2_nm > 0.0))
    still.ambient = AmbientOfPixels(view.scene, view.surroundings, optics_, still.mid, still.extra, threads_);
  return still;
}

std::vector<LightImages> LightModel::Expose(const TofView& view, const DepthSettings& settings,
                                            const FixedPattern& pattern, const Drift& drift) const {
  view.scene.Update(view.bodies);
  Still still = TakeStill(view);
  const bool moves = Moves(view), reuse = MayReuse(view, still.mid, settings);
  const std::vector<SubFrame> sub_frames = SubFrames(settings);
  std::vector<LightImages> images;
  for (std::size_t i = 0; i < sub_frames.size(); ++i) {
    const double frequency_hz = i < 4 ? settings.frequency_hz : settings.second_frequency_hz;
    if (effects_.multipath && i % 4 == 0) still.bounce = Bounce(view, still, frequency_hz, settings.integration_s);
    if (moves) view.scene.Update(view.bodies, sub_frames[i].Middle_s());
    const SubFrameTracer tracer(view.scene, optics_, still.mid, view.camera, sub_frames[i], reuse);
    images.push_back(Expose(still,
                            {moves ? &tracer : nullptr, frequency_hz, settings.integration_s, static_cast<int>(i % 4)},
                            pattern, drift));
  }
  if (effects_.scatter) {
    ParallelFor(2 * settings.sub_frames(), threads_, [&](int i) {
      LightImages& of = images[static_cast<std::size_t>(i / 2)];
      scatter_.Apply(i % 2 == 0 ? of.total_e : of.correlation_e);
    });
  }
  return images;
}

LightImages LightModel::Expose(const Still& still, const Now& now, const FixedPattern& pattern,
                               const Drift& drift) const {
  const std::size_t width = static_cast<std::size_t>(optics_.width);
  const double wave_number = WaveNumber(now.frequency_hz), contrast = sheet_.Contrast(now.frequency_hz);
  const double K_T = sheet_.signal_e_m2_per_us * now.integration_s * 1e6;
  const double ambient_gain = K_T * errors_.filter_nm / errors_.lamp_w_per_sr;  // [e] of albedo times irradiance
  const double a3 = effects_.wiggling ? errors_.harmonic_3 : 0.0, a5 = effects_.wiggling ? errors_.harmonic_5 : 0.0;
  const PhasorScale scale{K_T / optics_.per_pixel, wave_number, still.lamp_albedo};
  LightImages images{std::vector<float>(optics_.pixels()), std::vector<float>(optics_.pixels()),
                     std::vector<std::uint8_t>(optics_.pixels())};
  ParallelFor(optics_.height, threads_, [&](int v) {
    const std::size_t row = static_cast<std::size_t>(v);
    RowHits hits;
    if (now.tracer != nullptr)
      now.tracer->Row(v, hits);
    else
      RowOfMid(optics_, still.mid, v, hits);
    std::vector<Phasors> lights(width);
    const std::span<const ExtraReturn> extra(still.extra.data() + still.extra_from[row],
                                             still.extra.data() + still.extra_from[row + 1]);
    RowPhasors(hits, optics_, scale, still.mid, still.shadow, extra, v, lights);
    for (std::size_t u = 0; u < width; ++u) {
      const std::size_t pixel = row * width + u;
      Phasors& light = lights[u];
      images.lit[pixel] = light.total_e > 0.0f;
      if (!still.bounce.empty()) light += still.bounce[pixel];
      const double ambient_e = still.ambient.empty() ? 0.0 : ambient_gain * optics_.lens[pixel] * still.ambient[pixel];
      const double offset_m = pattern.range_m[pixel] + drift.range_m + Offset_m(light, ambient_e, contrast);
      if (offset_m != 0.0) light.Turn(wave_number * offset_m);
      images.total_e[pixel] = light.total_e + static_cast<float>(ambient_e);
      images.correlation_e[pixel] = static_cast<float>(contrast * Correlate(light, now.k, a3, a5));
    }
  });
  return images;
}

std::vector<Phasors> LightModel::Bounce(const TofView& view, const Still& still, double frequency_hz,
                                        double integration_s) const {
  const double K_T = sheet_.signal_e_m2_per_us * integration_s * 1e6, wave_number = WaveNumber(frequency_hz);
  const std::size_t n = static_cast<std::size_t>(optics_.per_pixel);
  std::vector<Phasors> bounce = OneBounce(view.scene, optics_, still.mid, still.lamp_albedo, wave_number, {}, threads_);
  for (std::size_t pixel = 0; pixel < bounce.size(); ++pixel) {
    const RayHit& hit = still.mid.hits[pixel * n + n / 2];
    if (hit.geom < 0) continue;
    bounce[pixel].Scale(K_T * optics_.lens[pixel] *
                        view.surroundings.material[static_cast<std::size_t>(hit.geom)].nir_albedo);
    bounce[pixel].Turn(0.5 * wave_number * hit.range_m);  // back to the lens
  }
  return bounce;
}

// Offsets of the phase as lengths: intensity, ambient light.
double LightModel::Offset_m(const Phasors& light, double ambient_e, double contrast) const {
  double offset_m = 0.0;
  if (effects_.intensity) {
    // The amplitude of albedo 0.2 at 3 m in 1 ms at 20 MHz.
    const double amplitude_0_e = sheet_.LampAmplitude_e_m2({}) * 0.2 / 9.0;
    offset_m += errors_.intensity_bias_m *
                std::exp(-contrast * std::sqrt(light.re[0] * light.re[0] + light.im[0] * light.im[0]) / amplitude_0_e);
  }
  if (effects_.sunlight) offset_m += errors_.ambient_bias_m * ambient_e / sheet_.full_well_e;
  return offset_m;
}

}  // namespace merlin::sim
