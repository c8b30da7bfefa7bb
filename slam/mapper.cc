#include "slam/mapper.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "slam/loop/find_place.h"
#include "slam/map/moved_away.h"

namespace merlin {
namespace {

constexpr std::size_t kViewsMax = 4;   // of a key frame: its own, and three, as many as decide that something has gone
constexpr double kViewsApart_s = 0.3;  // between two views of one place, while the car does not move...
constexpr double kAgainApart_s = 0.8;  // ...or comes by again: a further lap keeps less than 10 MB
constexpr double kRecent_m = 1.0;      // loops are searched with what was seen over this distance
constexpr double kSearchedIn_m =
    4.0;                              // and a former map with what was seen over this one: more tells more places apart
constexpr double kNear_m = 4.0;       // former key frames with view centres nearer than this join the local map...
constexpr int kRecalledPerFrame = 2;  // ...so many a frame: it keeps up at 4 m/s
constexpr double kPruneEvery_m = 1.0;
constexpr Duration kBetweenRuns = std::chrono::seconds(1);
// When the run has ended, a drifted place is searched each so many metres, and confirmed so far before.
constexpr double kSearchedEvery_m = 2.0, kConfirmed_m = 0.3;

double DistanceOfViews_m(const Pose& a, const Pose& b) { return (ViewCentre(a) - ViewCentre(b)).norm(); }

}  // namespace

Pose Mapper::Add(const Observation& observation, const Pose& T_map_base, double path_m, std::optional<double> yaw_rad) {
  path_m_ = path_m;
  Keep(observation, T_map_base, yaw_rad);
  const Pose T_map_corrected = closer_.IsDue(path_m) ? CloseLoop(observation, T_map_base) : T_map_base;
  if (closer_.KnowsThePlace(path_m)) RecallFormerVisit(T_map_corrected);
  return T_map_corrected;
}

void Mapper::EndFrame(double path_m) {
  if (path_m - pruned_at_m_ > kPruneEvery_m) {
    local_.ForgetBefore(path_m - config_.local_length_m);
    pruned_at_m_ = path_m;
  }
  grid_.Follow(keyframes_);
}

// A new key frame, or, where the place has one already, one more view of it.
void Mapper::Keep(const Observation& observation, const Pose& T_map_base, std::optional<double> yaw_rad) {
  if (keyframes_.empty()) {
    AddKeyframe(observation, T_map_base, Pose::Identity(), yaw_rad);
    keyframes_.back().first_of_run = true;
    return;
  }
  const Pose since = keyframes_.back().T_map_base.inverse() * T_map_base;
  const double view_turn_rad = Yaw(since) + observation.view_yaw_rad - keyframes_.back().view_yaw_rad;
  const double least_turn_rad =
      observation.pans ? std::max(config_.keyframe_angle_rad, observation.half_view_rad) : config_.keyframe_angle_rad;
  const bool moved =
      since.translation().norm() >= config_.keyframe_distance_m || std::abs(view_turn_rad) >= least_turn_rad;
  if (!moved) return AddView(observation, T_map_base, keyframes_.back());
  if (Keyframe* const former = NearestOfFormerVisit(T_map_base, observation.view_yaw_rad))
    return AddView(observation, T_map_base, *former);
  AddKeyframe(observation, T_map_base, since, yaw_rad);
}

void Mapper::AddKeyframe(const Observation& observation, const Pose& T_map_base, const Pose& T_previous_base,
                         std::optional<double> yaw_rad) {
  local_.Insert(observation.points_base, T_map_base, path_m_);
  keyframes_.push_back({.stamp = observation.stamp,
                        .T_map_base = T_map_base,
                        .T_previous_base = T_previous_base,
                        .path_m = path_m_,
                        .yaw_rad = yaw_rad,
                        .yaw_sigma_rad = observation.yaw_sigma_rad,
                        .view_yaw_rad = observation.view_yaw_rad,
                        .points_base = observation.points_base,
                        .camera_base = observation.camera_base,
                        .views = {{observation.stamp, Pose::Identity(), ClearView(observation)}},
                        .in_local_map_m = path_m_});
  grid_.Add(keyframes_.back());
  viewed_at_ = observation.stamp;
}

// What has come or gone in a place that has a key frame is worth keeping, though it needs no further key frame.
void Mapper::AddView(const Observation& observation, const Pose& T_map_base, Keyframe& keyframe) {
  const bool again = &keyframe != &keyframes_.back();
  if (Seconds(observation.stamp - viewed_at_) < (again ? kAgainApart_s : kViewsApart_s)) return;
  viewed_at_ = observation.stamp;
  std::vector<PlacedView>& views = keyframe.views;
  if (views.size() == kViewsMax) views.erase(views.begin() + 1);
  views.push_back({observation.stamp, keyframe.T_map_base.inverse() * T_map_base, ClearView(observation)});
}

// Null: the place is not known from a former visit, or no key frame of it is near.
Keyframe* Mapper::NearestOfFormerVisit(const Pose& T_map_base, double view_yaw_rad) {
  Keyframe* nearest = nullptr;
  double nearest_m = config_.revisit_m;
  if (!closer_.KnowsThePlace(path_m_)) return nullptr;
  for (Keyframe& keyframe : keyframes_) {
    if (path_m_ - keyframe.path_m < config_.loop.apart_m) continue;
    const double turn_rad = WrapPi(Yaw(keyframe.T_map_base) - Yaw(T_map_base) + keyframe.view_yaw_rad - view_yaw_rad);
    if (std::abs(turn_rad) >= config_.revisit_rad) continue;
    const double distance_m = (keyframe.T_map_base.translation() - T_map_base.translation()).head<2>().norm();
    if (distance_m < nearest_m) nearest = &keyframe, nearest_m = distance_m;
  }
  return nearest;
}

std::vector<Point> Mapper::RecentPoints(const Observation& observation, const Pose& T_map_base) const {
  return RecentPoints(observation.points_base, keyframes_.size() - 1, T_map_base, path_m_, kSearchedIn_m);
}

// The points, and those of the key frames up to `newest` that are on the last over_m before path_m, thinned.
std::vector<Point> Mapper::RecentPoints(std::vector<Point> points_base, std::size_t newest, const Pose& T_map_base,
                                        double path_m, double over_m) const {
  for (std::size_t i = newest + 1; i-- > 0 && path_m - keyframes_[i].path_m < over_m;) {
    const Eigen::Isometry3f T = (T_map_base.inverse() * keyframes_[i].T_map_base).cast<float>();
    for (Point point : keyframes_[i].points_base) {
      point.position = T * point.position;
      points_base.push_back(point);
    }
  }
  return Downsample(points_base, config_.source_voxel_m);
}

// The pose of this frame, corrected where it closes a loop.
Pose Mapper::CloseLoop(const Observation& observation, const Pose& T_map_base) {
  const std::vector<Point> points =
      RecentPoints(observation.points_base, keyframes_.size() - 1, T_map_base, path_m_, kRecent_m);
  const auto corrected = closer_.Search(keyframes_, points, T_map_base, path_m_);
  if (!corrected) return T_map_base;
  double moved_m = 0.0;
  for (std::size_t i = 0; i < corrected->size(); ++i)
    moved_m = std::max(moved_m, ((*corrected)[i].translation() - keyframes_[i].T_map_base.translation()).norm());
  if (moved_m < config_.correction_min_m) return T_map_base;
  const Pose T_map_corrected = corrected->back() * keyframes_.back().T_map_base.inverse() * T_map_base;
  MoveKeyframes(*corrected);
  return T_map_corrected;
}

void Mapper::Finish() {
  if (!config_.loop.enabled) return;
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    const double path_m = keyframes_[i].path_m;
    if (closer_.SinceLoop_m(path_m) <= 0.0 || closer_.KnowsThePlace(path_m)) continue;
    const Pose T_map_base = keyframes_[i].T_map_base;
    if (const auto corrected =
            closer_.Search(keyframes_, RecentPoints({}, i, T_map_base, path_m, kRecent_m), T_map_base, path_m))
      MoveKeyframes(*corrected);
  }
  if (closer_.loops() == 0) SearchWherePoseDrifted();
}

// From the end of the run backwards: there the drift is largest, and its correction reaches the most key frames. A place
// that was found is confirmed a little before it.
void Mapper::SearchWherePoseDrifted() {
  double next_m = path_m_;
  for (std::size_t i = keyframes_.size(); i-- > 0 && keyframes_[i].path_m > config_.loop.apart_m;) {
    const double path_m = keyframes_[i].path_m;
    if (path_m > next_m) continue;
    const auto later = std::ranges::upper_bound(keyframes_, path_m - config_.loop.apart_m, {}, &Keyframe::path_m);
    const std::span<const Keyframe> former(keyframes_.begin(), later);
    const Pose T_map_base = keyframes_[i].T_map_base;
    const PlanRegion reach{T_map_base, config_.loop.reach_m + config_.loop.reach_share * path_m, config_.loop.turn_rad};
    const PlaceFinder finder(former, config_.loop, config_.occupancy);
    const auto place = finder.Find(former, RecentPoints({}, i, T_map_base, path_m, kRecent_m), reach).place;
    next_m = path_m - (place ? kConfirmed_m : kSearchedEvery_m);
    if (const auto corrected = closer_.Take(keyframes_, place, T_map_base, path_m)) return MoveKeyframes(*corrected);
  }
}

void Mapper::MoveKeyframes(const std::vector<Pose>& corrected) {
  for (std::size_t i = 0; i < corrected.size(); ++i) keyframes_[i].T_map_base = corrected[i];
  grid_.Renew();
  RenewLocalMap();
}

// At once, because the next frame is registered against it.
void Mapper::RenewLocalMap() {
  const Pose T_map_newest = keyframes_.back().T_map_base;
  std::vector<PlacedPoints> near;
  for (Keyframe& keyframe : keyframes_) {
    const bool recent = path_m_ - keyframe.path_m < config_.local_length_m;
    if (!recent && DistanceOfViews_m(keyframe.T_map_base, T_map_newest) > kNear_m) continue;
    near.push_back({keyframe.points_base, keyframe.T_map_base});
    keyframe.in_local_map_m = path_m_;
  }
  local_ = VoxelMap(config_.local);
  local_.InsertAll(near, path_m_);
}

// To the rest of the mapper the former run is an earlier visit: driven, and over, before this run began.
void Mapper::Join(SavedMap former, const Pose& T_former_map, const Loop& place, double heading_turn_rad) {
  const double earlier_m = former.keyframes.back().path_m + config_.loop.apart_m;
  Time earlier = former.keyframes.back().stamp;
  for (const Keyframe& keyframe : former.keyframes)
    for (const PlacedView& placed : keyframe.views) earlier = std::max(earlier, placed.stamp);
  earlier += kBetweenRuns;
  for (Keyframe& keyframe : former.keyframes) {
    keyframe.path_m -= earlier_m, keyframe.in_local_map_m -= earlier_m;
    keyframe.stamp -= earlier;
    for (PlacedView& placed : keyframe.views) placed.stamp -= earlier;
  }
  for (Keyframe& keyframe : keyframes_) {
    keyframe.T_map_base = T_former_map * keyframe.T_map_base;
    if (keyframe.yaw_rad) keyframe.yaw_rad = WrapPi(*keyframe.yaw_rad + heading_turn_rad);
  }
  const std::size_t before = former.keyframes.size();
  former.keyframes.insert(former.keyframes.end(), std::make_move_iterator(keyframes_.begin()),
                          std::make_move_iterator(keyframes_.end()));
  keyframes_ = std::move(former.keyframes);
  closer_.Join(former.loops, before, keyframes_, place, path_m_);
  grid_.Restart(std::span(keyframes_).subspan(before));
  RenewLocalMap();
}

// Puts what a former visit saw here into the local map, so that the next frames are registered against it.
void Mapper::RecallFormerVisit(const Pose& T_map_base) {
  int left = kRecalledPerFrame;
  for (Keyframe& keyframe : keyframes_) {
    if (left == 0) return;
    if (path_m_ - keyframe.in_local_map_m < config_.local_length_m) continue;
    if (DistanceOfViews_m(keyframe.T_map_base, T_map_base) > kNear_m) continue;
    if (std::abs(WrapPi(Yaw(keyframe.T_map_base) - Yaw(T_map_base))) > config_.loop.turn_rad) continue;
    local_.Insert(keyframe.points_base, keyframe.T_map_base, path_m_);
    keyframe.in_local_map_m = path_m_;
    --left;
  }
}

VoxelMap Mapper::BuildMap() const {
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
