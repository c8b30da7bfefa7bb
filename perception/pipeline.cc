#include "perception/pipeline.h"

#include <cmath>
#include <utility>

namespace merlin {

Pipeline::Pipeline(Rig rig, const PerceptionConfig& config)
    : rig_(std::move(rig)),
      config_(config),
      rays_(PixelRays(rig_.depth.camera)),
      view_(FieldOfViewOf(rig_.depth.camera)),
      odometry_(rig_.car),
      heading_(config.heading) {}

void Pipeline::Add(const DriveState& state) {
  if (std::isfinite(state.steering_rad)) odometry_.Update(state);
}

void Pipeline::Add(const CompassReading& reading) {
  if (!std::isfinite(reading.yaw_rad)) return;
  if (const auto T_odom_base = OdomAt(reading.stamp))
    heading_.Update(reading.stamp, reading.yaw_rad, Yaw(*T_odom_base));
}

void Pipeline::Add(std::shared_ptr<const ColorFrame> frame) { color_ = std::move(frame); }

std::optional<Pose> Pipeline::OdomAt(Time time) const {
  const auto T_odom_base = odometry_.At(time);
  if (!T_odom_base || !rig_.on_turntable) return T_odom_base;
  const auto angle_rad = turntable_.At(time);
  if (!angle_rad) return std::nullopt;
  const Pose T_base_turntable = rig_.car.T_base_turntable();
  return *T_odom_base * T_base_turntable * FromXyYaw(0.0, 0.0, *angle_rad) * T_base_turntable.inverse();
}

std::optional<Pose> Pipeline::CameraAt(const Pose& T_base_camera, Time time) const {
  if (!rig_.pans) return T_base_camera;
  const auto angle_rad = pan_.At(time);
  if (!angle_rad) return std::nullopt;
  return rig_.car.pan->Turned(T_base_camera, *angle_rad);
}

std::optional<Observation> Pipeline::Process(DepthFrame frame) {
  const auto T_odom_base = OdomAt(frame.stamp), T_base_depth = CameraAt(rig_.T_base_depth, frame.stamp);
  if (!T_odom_base || !T_base_depth) return std::nullopt;

  Observation observation;
  observation.stamp = frame.stamp;
  observation.T_odom_base = *T_odom_base;
  if (rig_.pans) observation.view_yaw_rad = *pan_.At(frame.stamp);
  observation.pans = rig_.pans;
  observation.half_view_rad = view_.half_rad;
  observation.half_view_up_rad = view_.half_up_rad;
  observation.yaw_rad = heading_.Yaw_rad(Yaw(*T_odom_base));
  observation.yaw_sigma_rad = heading_.Sigma_rad(frame.stamp, Yaw(*T_odom_base));

  const FilteredDepth filtered = FilterDepth(std::move(frame), rig_.depth, config_.filter);
  ProjectDepth(filtered, rig_.depth, rays_, *T_base_depth, observation);

  if (color_ && rig_.color && std::abs(Seconds(observation.stamp - color_->stamp)) <= config_.color_age_max_s) {
    const Pose T_odom_basecolor = *OdomAt(color_->stamp), T_base_color = *CameraAt(rig_.T_base_color, color_->stamp);
    const Pose T_color_base = T_base_color.inverse() * T_odom_basecolor.inverse() * *T_odom_base;
    ColorPoints(observation.points_base, *color_, rig_.color->camera, T_color_base, 1.0 / rig_.depth.camera.fx_px);
  }
  return observation;
}

}  // namespace merlin
