#include "sim/tof/tof_camera.h"

#include <algorithm>
#include <utility>

namespace merlin::sim {
namespace {

PixelScene Look(const RayHit& hit, const Eigen::Vector3f& direction_world, std::span<const double> albedo) {
  if (hit.geom < 0) return {};
  return {.range_m = hit.range_m,
          .cos_incidence = std::clamp(static_cast<double>(-hit.normal.dot(direction_world)), 0.0, 1.0),
          .albedo = albedo[static_cast<std::size_t>(hit.geom)]};
}

DepthFrame EmptyFrame(const CameraModel& camera, const DepthSettings& settings, Time stamp, std::uint64_t index) {
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  return {.stamp = stamp,
          .index = index,
          .settings = settings,
          .width = camera.width,
          .height = camera.height,
          .range_m = std::vector<float>(pixels),
          .amplitude = std::vector<float>(pixels),
          .intensity = std::vector<float>(pixels),
          .flags = std::vector<std::uint8_t>(pixels)};
}

}  // namespace

TofCamera::TofCamera(DepthCameraSheet sheet, TofEffects effects, std::uint64_t seed)
    : sheet_(std::move(sheet)), effects_(effects), seed_(seed) {
  for (int v = 0; v < sheet_.camera.height; ++v) {
    for (int u = 0; u < sheet_.camera.width; ++u) rays_.push_back(sheet_.camera.Ray(u, v).cast<float>());
  }
}

DepthFrame TofCamera::Expose(const RayScene& scene, std::span<const double> albedo, const Pose& T_world_camera,
                             const DepthSettings& settings, Time stamp, std::uint64_t index) const {
  std::vector<Eigen::Vector3f> directions_world(rays_.size());
  const Eigen::Matrix3f R_world_camera = T_world_camera.linear().cast<float>();
  std::ranges::transform(rays_, directions_world.begin(),
                         [&](const Eigen::Vector3f& ray) -> Eigen::Vector3f { return R_world_camera * ray; });
  std::vector<RayHit> hits(rays_.size());
  scene.Cast(T_world_camera.translation(), directions_world, hits);

  DepthFrame frame = EmptyFrame(sheet_.camera, settings, stamp, index);
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    Random random(seed_, Sensor::kDepth, index, static_cast<std::uint32_t>(i));
    const PixelScene pixel = Look(hits[i], directions_world[i], albedo);
    const PixelTaps taps = ExposePixel(pixel, sheet_, settings, effects_, random);
    const PixelReading reading = DecodePixel(taps, settings.frequency_hz);
    const bool seen = pixel.range_m >= 0.0;
    frame.range_m[i] = seen ? reading.range_m : 0.0f;
    frame.amplitude[i] = reading.amplitude;
    frame.intensity[i] = reading.intensity;
    frame.flags[i] = static_cast<std::uint8_t>((seen ? 0 : kInvalid) | (taps.saturated ? kSaturated : 0) |
                                               (reading.amplitude < sheet_.low_signal_amplitude_e ? kLowSignal : 0));
  }
  return frame;
}

}  // namespace merlin::sim
