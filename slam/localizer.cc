#include "slam/localizer.h"

#include <algorithm>
#include <vector>

#include "slam/register/thin_source.h"

namespace merlin {
namespace {

constexpr double kBridge_m = 0.3;   // odometry alone is good enough for the map over this distance
constexpr double kAtRest_m = 1e-3;  // a car that moves less from one frame to the next does not move

bool HasHeading(const Observation& observation) { return std::isfinite(observation.yaw_sigma_rad); }

}  // namespace

bool Localizer::Begin(const Observation& observation) {
  if (!first_stamp_) first_stamp_ = observation.stamp;
  if (!T_map_last_) {
    const bool settled = observation.yaw_sigma_rad <= config_.start_sigma_rad;
    if (!settled && Seconds(observation.stamp - *first_stamp_) < config_.start_wait_s) return false;
    T_odom_last_ = observation.T_odom_base;
    T_map_last_ = FromXyYaw(0.0, 0.0, HasHeading(observation) ? observation.yaw_rad : 0.0);
  }
  // A map that began without a heading keeps its own direction when one comes.
  if (HasHeading(observation) && !map_turn_rad_) {
    const Pose T_map_base = *T_map_last_ * (T_odom_last_.inverse() * observation.T_odom_base);
    map_turn_rad_ = WrapPi(Yaw(T_map_base) - observation.yaw_rad);
  }
  return true;
}

Localization Localizer::Localize(const Observation& observation, const VoxelMap& local_map, bool has_map) {
  const Pose motion = T_odom_last_.inverse() * observation.T_odom_base;
  const PosePrior guess = Guess(observation, motion);
  const std::vector<Point> source =
      ThinSource(observation.points_base, config_.source_voxel_m, config_.source_points_min);
  last_ = Register(source, observation.camera_base, local_map, guess, config_.icp);
  const bool enough_points = static_cast<int>(source.size()) >= config_.icp.inliers_min;
  const bool on_new_ground = has_map && enough_points && SeesNewGround(observation, source.size());
  if (!on_new_ground) lost_frames_ = last_.converged || !has_map ? 0 : lost_frames_ + 1;
  T_map_last_ = last_.converged ? last_.T_map_base : guess.T_map_base;
  T_odom_last_ = observation.T_odom_base;

  const double distance_m = motion.translation().norm();
  path_m_ += distance_m;
  if (last_.converged) fitted_at_m_ = path_m_;
  if (last_.converged) MeasureSlip(motion, guess.T_map_base.inverse() * last_.T_map_base);
  const bool restarts = GivesUp(observation.stamp, distance_m >= kAtRest_m) && enough_points;
  if (restarts) lost_frames_ = 0;
  return {*T_map_last_, has_map ? last_.converged || on_new_ground || restarts : enough_points};
}

void Localizer::ChangeMap(const Pose& T_new_map, std::optional<double> heading_turn_rad) {
  if (T_map_last_) T_map_last_ = T_new_map * *T_map_last_;
  if (heading_turn_rad)
    map_turn_rad_ = heading_turn_rad;
  else if (map_turn_rad_)
    map_turn_rad_ = WrapPi(*map_turn_rad_ + Yaw(T_new_map));
}

std::optional<double> Localizer::MapYaw_rad(const Observation& observation) const {
  if (!HasHeading(observation) || !map_turn_rad_) return std::nullopt;
  return WrapPi(observation.yaw_rad + *map_turn_rad_);
}

// Position by odometry, yaw by the heading; without a heading by odometry too.
PosePrior Localizer::Guess(const Observation& observation, const Pose& motion) const {
  const Pose T_map_base = *T_map_last_ * motion;
  const double yaw_rad = MapYaw_rad(observation).value_or(Yaw(T_map_base));
  const double share = slipping() ? std::max(std::abs(slip_), config_.odometry_share) : config_.odometry_share;
  const double odometry_m = config_.odometry_floor_m + share * motion.translation().norm();
  const double yaw_sigma_rad = HasHeading(observation)
                                   ? std::max(observation.yaw_sigma_rad, config_.yaw_floor_rad)
                                   : config_.yaw_floor_rad + config_.odometry_share * std::abs(Yaw(motion));
  Vector6d sigma;
  sigma << odometry_m, odometry_m, config_.floor_sigma_m, config_.tilt_sigma_rad, config_.tilt_sigma_rad, yaw_sigma_rad;
  return {.T_map_base = FromXyYaw(T_map_base.translation().x(), T_map_base.translation().y(), yaw_rad),
          .information = sigma.cwiseAbs2().cwiseInverse().asDiagonal()};
}

// What registration adds along the distance that the wheels report, as a share of it. While the wheels slip, each frame
// takes back what that frame's own distance was wrong by.
void Localizer::MeasureSlip(const Pose& motion, const Pose& T_guess_registered) {
  const double distance_m = motion.translation().norm();
  if (distance_m <= 0.0) return;
  const double added = T_guess_registered.translation().dot(motion.translation()) / (distance_m * distance_m);
  slip_ += (1.0 - std::exp(-distance_m / config_.slip_memory_m)) * (added - slip_);
}

// A camera that turns looks where the map has nothing yet, such as at the other wall of a corridor. Its pose is known from
// the frames before.
bool Localizer::SeesNewGround(const Observation& observation, std::size_t points) const {
  return observation.pans && !last_.converged && 2 * static_cast<std::size_t>(last_.pairs) < points &&
         path_m_ - fitted_at_m_ <= kBridge_m;
}

// Nothing that the car sees has been in its map for a while, and it does not move. The error of odometry over the short
// distance since then is a lesser evil than to stop here for good.
bool Localizer::GivesUp(Time stamp, bool moves) {
  if (lost_frames_ == 0 || moves)
    lost_at_rest_.reset();
  else if (!lost_at_rest_)
    lost_at_rest_ = stamp;
  return lost_at_rest_ && Seconds(stamp - *lost_at_rest_) >= config_.restart_s;
}

}  // namespace merlin
