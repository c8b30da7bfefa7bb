// The occupancy grid of all key frames. A closed loop moves key frames by the hundred, and to enter them all again takes
// longer than one frame may: so a second grid is made beside the first, with an equal share of the key frames at every
// frame, and replaces it when it is whole. Counted in frames, not in time: a run gives the same bits on any machine.
//
//   frame        n                n+1 ... n+kFrames-1       n+kFrames
//   key frames   moved: Renew()   enter the second grid     all in it
//   readers see  the first grid, key frames where they were believed before, new ones where they are  |  the second grid
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "slam/keyframe.h"
#include "slam/map/occupancy_grid.h"

namespace merlin {

class KeyframeGrid {
 public:
  // A renewed grid is there after at most so many calls of Follow, 2 s of a camera at 20 Hz. Where the key frames move
  // again before, it is finished first and then made once more: after at most twice as many.
  static constexpr std::size_t kFrames = 40;

  explicit KeyframeGrid(const OccupancyConfig& config) : config_(config), grid_(config) {}

  // Enters a new key frame at once. At most one before each call of Follow.
  void Add(const Keyframe& keyframe);
  // The key frames have moved.
  void Renew() { moved_ = true; }
  // To be called once a frame. keyframes: all that were added, in that order.
  void Follow(std::span<const Keyframe> keyframes);

  const OccupancyGrid& grid() const { return grid_; }
  bool renewing() const { return moved_ || next_; }  // some key frames are in grid() where they were believed before

 private:
  OccupancyConfig config_;
  OccupancyGrid grid_;
  std::optional<OccupancyGrid> next_;    // with the first entered_ key frames
  std::size_t entered_ = 0, share_ = 0;  // share_: of them at each frame
  bool moved_ = false;                   // since next_ was begun
};

// The same grid, made at once.
OccupancyGrid GridOf(std::span<const Keyframe> keyframes, const OccupancyConfig& config);

}  // namespace merlin
