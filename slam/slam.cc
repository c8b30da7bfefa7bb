#include "slam/slam.h"

namespace merlin {

std::optional<Pose> Slam::Update(const Observation& observation) {
  if (!observation.T_odom_base.matrix().allFinite() || !localizer_.Begin(observation)) return std::nullopt;
  auto [T_map_base, trusted] = localizer_.Localize(observation, mapper_.local_map(), !keyframes().empty());
  if (trusted) T_map_base = mapper_.Add(observation, T_map_base, path_m(), localizer_.MapYaw_rad(observation));
  mapper_.EndFrame(path_m());
  localizer_.Correct(T_map_base);
  Record(observation.stamp, T_map_base);
  return T_map_base;
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
