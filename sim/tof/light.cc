#include "sim/tof/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/tof/parallel.h"

namespace merlin::sim {
namespace {

constexpr int kBand = 6;  // rows that one thread processes together

double WaveNumber(double frequency_hz) { return 4.0 * std::numbers::pi * frequency_hz / kSpeedOfLight_m_s; }

}  // namespace

// Scratch buffers that the rows of one thread share.
struct LightModel::RowScratch {
  explicit RowScratch(const Optics& optics)
      : work(static_cast<std::size_t>(optics.width), static_cast<std::size_t>(optics.per_pixel)),
        light(static_cast<std::size_t>(optics.width)),
        ambient_e(static_cast<std::size_t>(optics.width)),
        offset(static_cast<std::size_t>(optics.width)) {}
  RowHits hits;
  RowRays rays;
  RowWork work;
  PhasorRow light;
  std::vector<float> ambient_e, offset;  // offset of the phase: as a length [m], then as an angle [rad]
};

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
  return effects_.motion && (!view.camera.still() || !view.scene.Movers(view.bodies).empty());
}

// Sub-rays that need no tracing in the sub-frames: they see a plane, moving or not, and within the exposure no edge
// comes near them, by the motion of the camera and of the edge together.
std::vector<std::uint8_t> LightModel::Calm(const TofView& view, const MidHits& mid,
                                           const DepthSettings& settings) const {
  float nearest_m = 100.0f;
  for (const RayHit& hit : mid.hits)
    if (hit.geom >= 0) nearest_m = std::min(nearest_m, hit.range_m);
  const double span_s = sheet_.ExposureSpan_s(settings);
  double mover_px = 0.0;
  for (const Mover& mover : view.scene.Movers(view.bodies))
    mover_px = std::max(mover_px, PictureMotion_px(optics_, view.scene, mid, mover, span_s));
  const double motion_px = PictureMotion_px(optics_, view.camera, span_s, nearest_m) + mover_px;
  const double reach = std::ceil(std::min(mid.grid.edge * motion_px, 1e6));
  return CalmSubRays(mid.grid, mid.hits, static_cast<int>(reach));
}

LightModel::Still LightModel::TakeStill(const TofView& view) const {
  Still still(optics_);
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
  const bool moves = Moves(view);
  const FramePlan plan = moves ? PlanFrame(optics_, still.mid, Calm(view, still.mid, settings)) : FramePlan{};
  const std::vector<SubFrame> sub_frames = SubFrames(settings);
  std::vector<LightImages> images;
  for (std::size_t i = 0; i < sub_frames.size(); ++i) {
    const double frequency_hz = i < 4 ? settings.frequency_hz : settings.second_frequency_hz;
    if (effects_.multipath && i % 4 == 0) still.bounce = Bounce(view, still, frequency_hz, settings.integration_s);
    if (moves) view.scene.Update(view.bodies, sub_frames[i].Middle_s());
    std::optional<SubFrameTracer> tracer;
    if (moves) tracer.emplace(view.scene, optics_, plan, view.camera, sub_frames[i]);
    images.push_back(
        Expose(still, {tracer ? &*tracer : nullptr, frequency_hz, settings.integration_s, static_cast<int>(i % 4)},
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
  const std::size_t pixels = optics_.pixels();
  LightImages images{std::vector<float>(pixels), std::vector<float>(pixels), std::vector<std::uint8_t>(pixels)};
  ParallelFor((optics_.height + kBand - 1) / kBand, threads_, [&](int band) {
    RowScratch scratch(optics_);
    for (int v = band * kBand; v < std::min(optics_.height, (band + 1) * kBand); ++v)
      ExposeRow(still, now, pattern, drift, v, scratch, images);
  });
  return images;
}

void LightModel::ExposeRow(const Still& still, const Now& now, const FixedPattern& pattern, const Drift& drift, int v,
                           RowScratch& scratch, LightImages& images) const {
  const std::size_t width = static_cast<std::size_t>(optics_.width), row = static_cast<std::size_t>(v),
                    first = row * width;
  const double wave_number = WaveNumber(now.frequency_hz), contrast = sheet_.Contrast(now.frequency_hz);
  const double K_T = sheet_.signal_e_m2_per_us * now.integration_s * 1e6;
  if (now.tracer != nullptr)
    now.tracer->Row(v, scratch.hits, scratch.rays);
  else
    RowOfMid(optics_, still.mid, v, scratch.hits);
  const std::span<const ExtraReturn> extra(still.extra.data() + still.extra_from[row],
                                           still.extra.data() + still.extra_from[row + 1]);
  PhasorRow& light = scratch.light;
  RowPhasors(scratch.hits, optics_, {K_T / optics_.per_pixel, wave_number, still.lamp_albedo}, still.mid, still.shadow,
             extra, v, scratch.work, light);
  for (std::size_t u = 0; u < width; ++u) {
    images.lit[first + u] = light.total_e[u] > 0.0f;
    if (!still.bounce.empty()) light.Add(u, still.bounce[first + u]);
    scratch.ambient_e[u] = 0.0f;
  }
  if (!still.ambient.empty()) {
    const float gain =
        static_cast<float>(K_T * errors_.filter_nm / errors_.lamp_w_per_sr);  // [e] of albedo times irradiance
    for (std::size_t u = 0; u < width; ++u)
      scratch.ambient_e[u] = gain * optics_.lens[first + u] * still.ambient[first + u];
  }
  AddOffsets(contrast, scratch);
  for (std::size_t u = 0; u < width; ++u)
    scratch.offset[u] = static_cast<float>(wave_number) *
                        (scratch.offset[u] + pattern.range_m[first + u] + static_cast<float>(drift.range_m));
  light.Turn(scratch.offset);
  const std::array<float, 3> weights{1.0f, effects_.wiggling ? static_cast<float>(errors_.harmonic_3) : 0.0f,
                                     effects_.wiggling ? static_cast<float>(errors_.harmonic_5) : 0.0f};
  light.Correlate(now.k, weights, static_cast<float>(contrast), std::span(images.correlation_e).subspan(first, width));
  for (std::size_t u = 0; u < width; ++u) images.total_e[first + u] = light.total_e[u] + scratch.ambient_e[u];
}

std::vector<Phasors> LightModel::Bounce(const TofView& view, const Still& still, double frequency_hz,
                                        double integration_s) const {
  const double K_T = sheet_.signal_e_m2_per_us * integration_s * 1e6, wave_number = WaveNumber(frequency_hz);
  std::vector<Phasors> bounce = OneBounce(view.scene, optics_, still.mid, still.lamp_albedo, wave_number, {}, threads_);
  for (std::size_t pixel = 0; pixel < bounce.size(); ++pixel) {
    const RayHit& hit = still.mid.hits[optics_.Middle(pixel)];
    if (hit.geom < 0) continue;
    bounce[pixel].Scale(K_T * optics_.lens[pixel] *
                        view.surroundings.material[static_cast<std::size_t>(hit.geom)].nir_albedo);
    bounce[pixel].Turn(0.5 * wave_number * hit.range_m);  // on the way back to the lens
  }
  return bounce;
}

// Phase errors from intensity and ambient light, as lengths.
void LightModel::AddOffsets(double contrast, RowScratch& scratch) const {
  std::ranges::fill(scratch.offset, 0.0f);
  const std::vector<float>&re = scratch.light.re[0], &im = scratch.light.im[0];
  if (effects_.intensity) {
    // The amplitude of albedo 0.2 at 3 m in 1 ms at 20 MHz.
    const float amplitude_0_e = static_cast<float>(sheet_.LampAmplitude_e_m2({}) * 0.2 / 9.0);
    const float bias_m = static_cast<float>(errors_.intensity_bias_m);
    const float per_phasor = -static_cast<float>(contrast) / amplitude_0_e;
    for (std::size_t u = 0; u < re.size(); ++u)
      scratch.offset[u] += bias_m * std::exp(per_phasor * std::sqrt(re[u] * re[u] + im[u] * im[u]));
  }
  if (effects_.sunlight) {
    const float per_e_m = static_cast<float>(errors_.ambient_bias_m / sheet_.full_well_e);
    for (std::size_t u = 0; u < re.size(); ++u) scratch.offset[u] += per_e_m * scratch.ambient_e[u];
  }
}

}  // namespace merlin::sim
