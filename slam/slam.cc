#include "slam/slam.h"

#include <algorithm>
#include <cmath>

namespace merlin {

Slam::Slam(const SlamConfig& config) : config_(config), local_(config.local), occupancy_(config.occupancy) {}

PosePrior Slam::Predict(const Observation& observation) const {
  const Pose motion = T_odom_last_.inverse() * observation.T_odom_base;
  Pose T_map_base = trajectory_.back().T_map_base * motion;
  const bool has_heading = std::isfinite(observation.yaw_sigma_rad);
  const double yaw_rad = has_heading ? WrapPi(observation.yaw_rad + *map_turn_rad_) : Yaw(T_map_base);

  PosePrior prior;
  prior.T_map_base = FromXyYaw(T_map_base.translation().x(), T_map_base.translation().y(), yaw_rad);
  const double odometry_m = config_.odometry_floor_m + config_.odometry_share * motion.translation().norm();
  const double yaw_sigma_rad = has_heading ? std::max(observation.yaw_sigma_rad, config_.yaw_floor_rad)
                                           : config_.yaw_floor_rad + config_.odometry_share * std::abs(Yaw(motion));
  Vector6d sigma;
  sigma << odometry_m, odometry_m, config_.floor_sigma_m, config_.tilt_sigma_rad, config_.tilt_sigma_rad, yaw_sigma_rad;
  prior.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  return prior;
}

std::optional<Pose> Slam::Update(const Observation& observation) {
  if (!observation.T_odom_base.matrix().allFinite()) return std::nullopt;
  const bool has_heading = std::isfinite(observation.yaw_sigma_rad);
  if (!first_stamp_) first_stamp_ = observation.stamp;
  if (trajectory_.empty()) {
    const bool settled = observation.yaw_sigma_rad <= config_.start_sigma_rad;
    if (!settled && Seconds(observation.stamp - *first_stamp_) < config_.start_wait_s) return std::nullopt;
    T_odom_last_ = observation.T_odom_base;
    trajectory_.push_back({observation.stamp, FromXyYaw(0.0, 0.0, has_heading ? observation.yaw_rad : 0.0)});
  }

  // Mapping that began without a heading keeps its own direction when one comes.
  if (has_heading && !map_turn_rad_) {
    const Pose T_map_base = trajectory_.back().T_map_base * (T_odom_last_.inverse() * observation.T_odom_base);
    map_turn_rad_ = WrapPi(Yaw(T_map_base) - observation.yaw_rad);
  }

  const PosePrior prior = Predict(observation);
  const std::vector<Point> source = Downsample(observation.points_base, config_.source_voxel_m);
  last_ = Register(source, observation.camera_base, local_, prior, config_.icp);
  lost_frames_ = last_.converged || keyframes_.empty() ? 0 : lost_frames_ + 1;
  const Pose T_map_base = last_.converged ? last_.T_map_base : prior.T_map_base;

  path_m_ += (T_odom_last_.inverse() * observation.T_odom_base).translation().norm();
  T_odom_last_ = observation.T_odom_base;
  if (trajectory_.back().stamp == observation.stamp) trajectory_.pop_back();
  trajectory_.push_back({observation.stamp, T_map_base});

  const Pose since_keyframe = keyframes_.empty() ? Pose::Identity() : keyframes_.back().T_map_base.inverse() * T_map_base;
  // The first key frame must be something to hold on to; later ones must have held on to it.
  const bool trusted = keyframes_.empty() ? static_cast<int>(source.size()) >= config_.icp.inliers_min : last_.converged;
  const bool moved = keyframes_.empty() || since_keyframe.translation().norm() >= config_.keyframe_distance_m ||
                    std::abs(Yaw(since_keyframe)) >= config_.keyframe_angle_rad;
  if (trusted && moved) {
    local_.Insert(observation.points_base, T_map_base, path_m_);
    occupancy_.Insert(observation, T_map_base);
    keyframes_.push_back({observation.stamp, T_map_base, observation.points_base});
  }
  if (path_m_ - pruned_at_m_ > 1.0) {
    local_.ForgetBefore(path_m_ - config_.local_length_m);
    pruned_at_m_ = path_m_;
  }
  return T_map_base;
}

VoxelMap Slam::BuildMap() const {
  VoxelMapConfig config = config_.local;
  config.voxel_m = config_.map_voxel_m;
  VoxelMap map(config);
  for (const Keyframe& keyframe : keyframes_) map.Insert(keyframe.points_base, keyframe.T_map_base, 0.0);
  return map;
}

}  // namespace merlin
