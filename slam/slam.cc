#include "slam/slam.h"

#include <cmath>
#include <utility>

namespace merlin {

Slam::Slam(const SlamConfig& config, const Footprint& footprint, std::optional<SavedMap> former)
    : config_(config), localizer_(config), mapper_(config, footprint) {
  if (!former) return;
  search_state_ = Search::kSearching;
  place_search_.emplace(*std::move(former), config);
}

std::optional<Pose> Slam::Update(const Observation& observation) {
  T_map_before_.reset();
  if (!first_stamp_) first_stamp_ = observation.stamp;
  if (!observation.T_odom_base.matrix().allFinite() || !localizer_.Begin(observation)) return std::nullopt;
  auto [T_map_base, trusted] = localizer_.Localize(observation, mapper_.local_map(), !keyframes().empty());
  if (trusted) T_map_base = mapper_.Add(observation, T_map_base, path_m(), localizer_.MapYaw_rad(observation));
  if (search_state_ == Search::kSearching) T_map_base = SearchPlace(observation, T_map_base, trusted);
  mapper_.EndFrame(path_m());
  localizer_.Correct(T_map_base);
  Record(observation.stamp, T_map_base);
  return T_map_base;
}

// The pose in the map, which is the former one where the place is found.
Pose Slam::SearchPlace(const Observation& observation, const Pose& T_map_base, bool trusted) {
  effort_ = {Seconds(observation.stamp - *first_stamp_), path_m()};
  if (trusted && place_search_->IsDue(T_map_base)) {
    const std::optional<double> heading_rad =
        std::isfinite(observation.yaw_sigma_rad) ? std::optional(observation.yaw_rad) : std::nullopt;
    const auto place = place_search_->Search(mapper_.RecentPoints(observation, T_map_base), T_map_base, heading_rad);
    if (place) {
      Join(*place, T_map_base);
      return *T_map_before_ * T_map_base;
    }
  }
  if (effort_.time_s > config_.search.give_up_s || effort_.path_m > config_.search.give_up_m) {
    search_state_ = Search::kGaveUp;
    place_search_.reset();
  }
  return T_map_base;
}

// The two map frames differ by a motion in the plane: both lie on the ground.
void Slam::Join(const Loop& place, const Pose& T_map_base) {
  const Pose found = place.T_map_base * T_map_base.inverse();
  const Pose T_former_map = FromXyYaw(found.translation().x(), found.translation().y(), Yaw(found));
  SavedMap former = place_search_->Release();
  const std::optional<double> turn_before_rad = localizer_.heading_turn_rad();
  localizer_.ChangeMap(T_former_map, former.heading_turn_rad);
  const double turn_rad = localizer_.heading_turn_rad().value_or(0.0) - turn_before_rad.value_or(0.0);
  for (MapPose& pose : online_) pose.T_map_base = T_former_map * pose.T_map_base;
  for (Step& step : steps_)
    if (step.keyframe)
      *step.keyframe += former.keyframes.size();
    else
      step.T_keyframe_base = T_former_map * step.T_keyframe_base;
  Loop in_plane = place;
  in_plane.T_map_base = T_former_map * T_map_base;
  mapper_.Join(std::move(former), T_former_map, in_plane, turn_rad);
  T_map_before_ = T_former_map;
  search_state_ = Search::kFound;
  place_search_.reset();
}

void Slam::Record(Time stamp, const Pose& T_map_base) {
  if (!online_.empty() && online_.back().stamp == stamp) online_.pop_back(), steps_.pop_back();
  online_.push_back({stamp, T_map_base});
  if (keyframes().empty())
    steps_.push_back({std::nullopt, T_map_base});
  else
    steps_.push_back({keyframes().size() - 1, keyframes().back().T_map_base.inverse() * T_map_base});
}

std::vector<MapPose> Slam::trajectory() const {
  std::vector<MapPose> poses = online_;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (steps_[i].keyframe)
      poses[i].T_map_base = keyframes()[*steps_[i].keyframe].T_map_base * steps_[i].T_keyframe_base;
  return poses;
}

}  // namespace merlin
