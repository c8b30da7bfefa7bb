#include "perception/project.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin {

RangeSigma::RangeSigma(const DepthCameraSheet& sheet, const DepthSettings& settings)
    : scale_m_(kSpeedOfLight_m_s / (4.0 * std::numbers::sqrt2 * std::numbers::pi * settings.frequency_hz)),
      contrast_(sheet.Contrast(settings.frequency_hz)),
      noise_e2_(2.0 * sheet.read_noise_e * sheet.read_noise_e) {}

double RangeSigma::Of_m(double amplitude_e) const {
  return scale_m_ * std::sqrt(amplitude_e / contrast_ + noise_e2_) / amplitude_e;
}

FreeRange::FreeRange(const DepthCameraSheet& sheet, const DepthSettings& settings)
    : darkest_e_m2_(0.02 * sheet.LampAmplitude_e_m2(settings)),
      least_e_(sheet.low_signal_amplitude_e),
      farthest_m_(UnambiguousRange_m(settings)) {}

double FreeRange::Of_m(double amplitude_e) const {
  return std::min(std::sqrt(darkest_e_m2_ / std::max(least_e_, amplitude_e)), farthest_m_);
}

std::vector<Eigen::Vector3f> PixelRays(const CameraModel& camera) {
  std::vector<Eigen::Vector3f> rays;
  rays.reserve(static_cast<std::size_t>(camera.width) * camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) rays.push_back(camera.Ray(u, v).cast<float>());
  return rays;
}

FieldOfView FieldOfViewOf(const CameraModel& camera) {
  const auto from_axis = [&](double u, double v) {
    const Eigen::Vector3d ray = camera.Ray(u, v);
    return std::max(std::abs(ray.x()), std::abs(ray.y())) / ray.z();
  };
  const double right = camera.width - 0.5, below = camera.height - 0.5;
  return {.half_rad = std::atan(std::min(from_axis(-0.5, camera.cy_px), from_axis(right, camera.cy_px))),
          .half_up_rad = std::atan(std::min(from_axis(camera.cx_px, -0.5), from_axis(camera.cx_px, below)))};
}

namespace {

// Some drivers flag a dark pixel as invalid too. The amplitude of a saturated or inconsistent pixel is no measure of
// the light, so such a pixel is not called dark.
bool IsDark(const FilteredDepth& depth, std::size_t i) {
  const std::uint8_t flags = depth.frame.flags[i];
  return (depth.reasons[i] == Rejection::kGhost || (flags & kLowSignal) != 0) &&
         (flags & (kSaturated | kInconsistent)) == 0;
}

}  // namespace

void ProjectDepth(const FilteredDepth& depth, const DepthCameraSheet& sheet, const std::vector<Eigen::Vector3f>& rays,
                  const Pose& T_base_camera, Observation& observation) {
  const Eigen::Isometry3f T = T_base_camera.cast<float>();
  observation.camera_base = T.translation();
  observation.rejections = depth.counts;
  observation.points_base.clear();
  observation.free_base.clear();
  observation.saturated_base.clear();
  observation.unknown_base.clear();
  observation.pixel_sr = 1.0 / (sheet.camera.fx_px * sheet.camera.fy_px);
  observation.shortest_exposure = depth.frame.settings.integration_s <= sheet.integration_min_s;
  const RangeSigma sigma(sheet, depth.frame.settings);
  const FreeRange free_range(sheet, depth.frame.settings);
  for (std::size_t i = 0; i < depth.frame.size(); ++i) {
    const Eigen::Vector3f direction = T.linear() * rays[i];
    if (depth.reasons[i] == Rejection::kSaturated)
      observation.saturated_base.push_back(direction);
    else if (IsDark(depth, i)) {
      const double free_m = free_range.Of_m(depth.frame.amplitude[i]);
      observation.free_base.push_back(observation.camera_base + direction * static_cast<float>(free_m));
    } else if (depth.reasons[i] != Rejection::kNone)
      observation.unknown_base.push_back(direction);
    if (depth.reasons[i] != Rejection::kNone) continue;
    Point point;
    point.position = T * (rays[i] * depth.frame.range_m[i]);
    point.sigma_m = static_cast<float>(sigma.Of_m(depth.frame.amplitude[i]));
    observation.points_base.push_back(point);
  }
}

}  // namespace merlin
