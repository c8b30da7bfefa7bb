#include "slam/map/keyframe_grid.h"

#include <algorithm>
#include <utility>

namespace merlin {
namespace {

void Enter(OccupancyGrid& grid, const Keyframe& keyframe, const Footprint& footprint) {
  grid.Insert(keyframe.points_base, keyframe.camera_base, keyframe.T_map_base);
  grid.Cover(footprint, keyframe.T_map_base);
}

}  // namespace

void KeyframeGrid::Add(const Keyframe& keyframe) { Enter(grid_, keyframe, footprint_); }

void KeyframeGrid::Restart(std::span<const Keyframe> at_once) {
  grid_ = GridOf(at_once, config_, footprint_);
  next_.reset();
  moved_ = true;
}

void KeyframeGrid::Follow(std::span<const Keyframe> keyframes) {
  if (!next_ && moved_) {
    next_.emplace(config_);
    entered_ = 0;
    share_ = keyframes.size() / kFrames + 2;  // rounded up, and one that may be added meanwhile
    moved_ = false;
  }
  if (!next_) return;
  const std::size_t until = std::min(entered_ + share_, keyframes.size());
  for (; entered_ < until; ++entered_) Enter(*next_, keyframes[entered_], footprint_);
  if (entered_ < keyframes.size()) return;
  grid_ = std::move(*next_);
  next_.reset();
}

OccupancyGrid GridOf(std::span<const Keyframe> keyframes, const OccupancyConfig& config, const Footprint& footprint) {
  OccupancyGrid grid(config);
  for (const Keyframe& keyframe : keyframes) Enter(grid, keyframe, footprint);
  return grid;
}

}  // namespace merlin
