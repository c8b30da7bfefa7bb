#include "slam/slam.h"

#include <algorithm>
#include <cmath>

#include "slam/map/moved_away.h"

namespace merlin {
namespace {

constexpr int kRecallAtOnce = 2;        // former key frames put back into the local map a frame: it keeps up at 4 m/s
constexpr double kRecall_m = 4.0;       // of views whose middles are nearer than this
constexpr double kStands_m = 1e-3;      // from one frame to the next
constexpr double kSightsApart_s = 0.3;  // of a car that stands...
constexpr double kAgainApart_s = 0.8;   // ...or comes by again: a lap more keeps under 10 MB
constexpr std::size_t kSights = 4;      // a key frame's own, and three: as many as decide that something has gone
constexpr double kLate_m = 1.0;         // what was seen on the last metre looks for loops

}  // namespace

Slam::Slam(const SlamConfig& config, const Footprint& footprint)
    : config_(config), footprint_(footprint), local_(config.local), grid_(config.occupancy), closer_(config.loop) {}

PosePrior Slam::Predict(const Observation& observation) const {
  const Pose motion = T_odom_last_.inverse() * observation.T_odom_base;
  Pose T_map_base = *T_map_last_ * motion;
  const bool has_heading = std::isfinite(observation.yaw_sigma_rad);
  const double yaw_rad = has_heading ? WrapPi(observation.yaw_rad + *map_turn_rad_) : Yaw(T_map_base);

  PosePrior prior;
  prior.T_map_base = FromXyYaw(T_map_base.translation().x(), T_map_base.translation().y(), yaw_rad);
  const double share = slipping() ? std::max(std::abs(slip_), config_.odometry_share) : config_.odometry_share;
  const double odometry_m = config_.odometry_floor_m + share * motion.translation().norm();
  const double yaw_sigma_rad = has_heading ? std::max(observation.yaw_sigma_rad, config_.yaw_floor_rad)
                                           : config_.yaw_floor_rad + config_.odometry_share * std::abs(Yaw(motion));
  Vector6d sigma;
  sigma << odometry_m, odometry_m, config_.floor_sigma_m, config_.tilt_sigma_rad, config_.tilt_sigma_rad, yaw_sigma_rad;
  prior.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  return prior;
}

bool Slam::Begin(const Observation& observation) {
  const bool has_heading = std::isfinite(observation.yaw_sigma_rad);
  if (!first_stamp_) first_stamp_ = observation.stamp;
  if (!T_map_last_) {
    const bool settled = observation.yaw_sigma_rad <= config_.start_sigma_rad;
    if (!settled && Seconds(observation.stamp - *first_stamp_) < config_.start_wait_s) return false;
    T_odom_last_ = observation.T_odom_base;
    T_map_last_ = FromXyYaw(0.0, 0.0, has_heading ? observation.yaw_rad : 0.0);
  }
  // Mapping that began without a heading keeps its own direction when one comes.
  if (has_heading && !map_turn_rad_) {
    const Pose T_map_base = *T_map_last_ * (T_odom_last_.inverse() * observation.T_odom_base);
    map_turn_rad_ = WrapPi(Yaw(T_map_base) - observation.yaw_rad);
  }
  return true;
}

std::optional<Pose> Slam::Update(const Observation& observation) {
  if (!observation.T_odom_base.matrix().allFinite() || !Begin(observation)) return std::nullopt;
  const PosePrior prior = Predict(observation);
  const std::vector<Point> source = Downsample(observation.points_base, config_.source_voxel_m);
  last_ = Register(source, observation.camera_base, local_, prior, config_.icp);
  lost_frames_ = last_.converged || keyframes_.empty() ? 0 : lost_frames_ + 1;
  Pose T_map_base = last_.converged ? last_.T_map_base : prior.T_map_base;

  const Pose motion = T_odom_last_.inverse() * observation.T_odom_base;
  path_m_ += motion.translation().norm();
  T_odom_last_ = observation.T_odom_base;
  if (last_.converged) WatchWheels(motion, prior.T_map_base.inverse() * T_map_base);
  // The first key frame must be something to hold on to; later ones must have held on to it.
  const bool sees = static_cast<int>(source.size()) >= config_.icp.inliers_min;
  const bool restarts = GivesUp(observation.stamp, motion.translation().norm() < kStands_m) && sees;
  if (restarts) lost_frames_ = 0;
  const bool trusted = keyframes_.empty() ? sees : last_.converged || restarts;
  if (trusted) {
    Keep(observation, T_map_base);
    if (closer_.IsDue(path_m_)) SearchLoop(observation, T_map_base);
    if (closer_.KnowsThePlace(path_m_)) RecallFormer(T_map_base);
  }
  if (path_m_ - pruned_at_m_ > 1.0) {
    local_.ForgetBefore(path_m_ - config_.local_length_m);
    pruned_at_m_ = path_m_;
  }
  grid_.Follow(keyframes_);
  T_map_last_ = T_map_base;
  Record(observation.stamp, T_map_base);
  return T_map_base;
}

// Nothing that it sees has been in its map for a while, and the car stands: what odometry was wrong by on the little way
// since then is a lesser evil than to stand there for good.
bool Slam::GivesUp(Time stamp, bool stands) {
  if (lost_frames_ == 0 || !stands)
    lost_standing_.reset();
  else if (!lost_standing_)
    lost_standing_ = stamp;
  return lost_standing_ && Seconds(stamp - *lost_standing_) >= config_.restart_s;
}

// What registration adds to the way along it, as a share of the way, averaged. While the wheels slip it lags behind, but
// each frame it takes back what the frame's own way was wrong by.
void Slam::WatchWheels(const Pose& motion, const Pose& T_prior_registered) {
  const double way_m = motion.translation().norm();
  if (way_m <= 0.0) return;
  const double added = T_prior_registered.translation().dot(motion.translation()) / (way_m * way_m);
  slip_ += (1.0 - std::exp(-way_m / config_.slip_memory_m)) * (added - slip_);
}

void Slam::Record(Time stamp, const Pose& T_map_base) {
  if (!online_.empty() && online_.back().stamp == stamp) online_.pop_back(), steps_.pop_back();
  online_.push_back({stamp, T_map_base});
  if (keyframes_.empty())
    steps_.push_back({std::nullopt, T_map_base});
  else
    steps_.push_back({keyframes_.size() - 1, keyframes_.back().T_map_base.inverse() * T_map_base});
}

void Slam::Keep(const Observation& observation, const Pose& T_map_base) {
  const Pose since = keyframes_.empty() ? Pose::Identity() : keyframes_.back().T_map_base.inverse() * T_map_base;
  const bool moved = keyframes_.empty() || since.translation().norm() >= config_.keyframe_distance_m ||
                     std::abs(Yaw(since)) >= config_.keyframe_angle_rad;
  Keyframe* const former = moved ? FormerVisit(T_map_base) : nullptr;
  if (former != nullptr)
    Watch(observation, T_map_base, *former);
  else if (!moved)
    Watch(observation, T_map_base, keyframes_.back());
  if (!moved || former != nullptr) return;
  local_.Insert(observation.points_base, T_map_base, path_m_);
  Keyframe keyframe{.stamp = observation.stamp,
                    .T_map_base = T_map_base,
                    .T_previous_base = since,
                    .path_m = path_m_,
                    .yaw_rad = std::nullopt,
                    .yaw_sigma_rad = observation.yaw_sigma_rad,
                    .points_base = observation.points_base,
                    .camera_base = observation.camera_base,
                    .sights = {{observation.stamp, Pose::Identity(), ClearView(observation)}},
                    .in_local_map_m = path_m_};
  if (map_turn_rad_ && std::isfinite(observation.yaw_sigma_rad))
    keyframe.yaw_rad = WrapPi(observation.yaw_rad + *map_turn_rad_);
  keyframes_.push_back(std::move(keyframe));
  grid_.Add(keyframes_.back());
  sighted_at_ = observation.stamp;
}

// What has come or gone where the car stands, or comes by again, is news, though it is no place for another key frame.
void Slam::Watch(const Observation& observation, const Pose& T_map_base, Keyframe& keyframe) {
  std::vector<Sight>& sights = keyframe.sights;
  const bool again = &keyframe != &keyframes_.back();
  if (Seconds(observation.stamp - sighted_at_) < (again ? kAgainApart_s : kSightsApart_s)) return;
  sighted_at_ = observation.stamp;
  if (sights.size() == kSights) sights.erase(sights.begin() + 1);
  sights.push_back({observation.stamp, keyframe.T_map_base.inverse() * T_map_base, ClearView(observation)});
}

// The nearest of those that know the place.
Keyframe* Slam::FormerVisit(const Pose& T_map_base) {
  Keyframe* nearest = nullptr;
  double nearest_m = config_.revisit_m;
  if (!closer_.KnowsThePlace(path_m_)) return nullptr;
  for (Keyframe& keyframe : keyframes_) {
    if (path_m_ - keyframe.path_m < config_.loop.apart_m) continue;
    if (std::abs(WrapPi(Yaw(keyframe.T_map_base) - Yaw(T_map_base))) >= config_.revisit_rad) continue;
    const double distance_m = (keyframe.T_map_base.translation() - T_map_base.translation()).head<2>().norm();
    if (distance_m < nearest_m) nearest = &keyframe, nearest_m = distance_m;
  }
  return nearest;
}

// What a former visit saw here, for frames to be registered against.
void Slam::RecallFormer(const Pose& T_map_base) {
  int left = kRecallAtOnce;
  for (Keyframe& keyframe : keyframes_) {
    if (left == 0) return;
    if (path_m_ - keyframe.in_local_map_m < config_.local_length_m) continue;
    if ((ViewCentre(keyframe.T_map_base) - ViewCentre(T_map_base)).norm() > kRecall_m) continue;
    if (std::abs(WrapPi(Yaw(keyframe.T_map_base) - Yaw(T_map_base))) > config_.loop.turn_rad) continue;
    local_.Insert(keyframe.points_base, keyframe.T_map_base, path_m_);
    keyframe.in_local_map_m = path_m_;
    --left;
  }
}

// Of the key frames on the last metre and of this one, in its frame, thinned.
std::vector<Point> Slam::SeenOfLate(const Observation& observation, const Pose& T_map_base) const {
  std::vector<Point> points = observation.points_base;
  for (auto keyframe = keyframes_.rbegin(); keyframe != keyframes_.rend() && path_m_ - keyframe->path_m < kLate_m;
       ++keyframe) {
    const Eigen::Isometry3f T = (T_map_base.inverse() * keyframe->T_map_base).cast<float>();
    for (Point point : keyframe->points_base) {
      point.position = T * point.position;
      points.push_back(point);
    }
  }
  return Downsample(points, config_.source_voxel_m);
}

void Slam::SearchLoop(const Observation& observation, Pose& T_map_base) {
  const auto corrected = closer_.Search(keyframes_, SeenOfLate(observation, T_map_base), T_map_base, path_m_);
  if (!corrected) return;
  double moved_m = 0.0;
  for (std::size_t i = 0; i < corrected->size(); ++i)
    moved_m = std::max(moved_m, ((*corrected)[i].translation() - keyframes_[i].T_map_base.translation()).norm());
  if (moved_m < config_.correction_min_m) return;
  T_map_base = corrected->back() * keyframes_.back().T_map_base.inverse() * T_map_base;
  Correct(*corrected);
}

// Takes over the corrected poses. The local map is made anew at once, because the next frame is registered against it.
void Slam::Correct(const std::vector<Pose>& corrected) {
  for (std::size_t i = 0; i < corrected.size(); ++i) keyframes_[i].T_map_base = corrected[i];
  grid_.Renew();
  std::vector<PlacedPoints> near;
  for (Keyframe& keyframe : keyframes_) {
    if (path_m_ - keyframe.path_m >= config_.local_length_m &&
        (ViewCentre(keyframe.T_map_base) - ViewCentre(corrected.back())).norm() > kRecall_m)
      continue;
    near.push_back({keyframe.points_base, keyframe.T_map_base});
    keyframe.in_local_map_m = path_m_;
  }
  local_ = VoxelMap(config_.local);
  local_.InsertAll(near, path_m_);
}

std::vector<MapPose> Slam::trajectory() const {
  std::vector<MapPose> poses = online_;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (steps_[i].keyframe)
      poses[i].T_map_base = keyframes_[*steps_[i].keyframe].T_map_base * steps_[i].T_keyframe_base;
  return poses;
}

VoxelMap Slam::BuildMap() const {
  VoxelMapConfig config = config_.local;
  config.voxel_m = config_.map_voxel_m;
  VoxelMap map(config);
  std::vector<PlacedPoints> frames;
  for (const Keyframe& keyframe : keyframes_) frames.push_back({keyframe.points_base, keyframe.T_map_base});
  map.InsertAll(frames, 0.0);
  map.Forget(MovedAway(map.voxels(), keyframes_, footprint_));
  for (const Keyframe& keyframe : keyframes_)
    map.Paint(keyframe.points_base, keyframe.camera_base, keyframe.T_map_base);
  return map;
}

}  // namespace merlin
