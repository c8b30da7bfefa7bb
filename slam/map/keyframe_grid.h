// The occupancy grid of all key frames. A closed loop moves hundreds of key frames, and adding them all again takes
// longer than one frame may take. So a second grid is filled beside the first, with an equal share of the key frames at
// each frame, and replaces it when it is complete. The shares are counted in frames and not in time, so that a run
// gives the same bits on any machine.
//
//   frame        n                  n+1 ... n+kFrames-1                                  n+kFrames
//   key frames   moved: Renew()     a share of them is added to the second grid          all are in it
//   grid()       the first grid: old poses for former key frames, new key frames added   the second grid
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "slam/keyframe.h"
#include "slam/map/occupancy_grid.h"

namespace merlin {

class KeyframeGrid {
 public:
  // The grid is renewed after at most this many calls of Follow: 2 s of a camera at 20 Hz. Where the key frames move
  // again before, it is completed first and then made once more, so that twice as many calls may pass.
  static constexpr std::size_t kFrames = 40;

  // footprint: the car's. The ground that it covers at a key frame is known to be free.
  explicit KeyframeGrid(const OccupancyConfig& config, const Footprint& footprint = {})
      : config_(config), footprint_(footprint), grid_(config) {}

  // Adds a new key frame at once. At most one before each call of Follow.
  void Add(const Keyframe& keyframe);
  // The key frames have moved.
  void Renew() { moved_ = true; }
  // The key frames are others, in another frame: those given are in the grid at once, all others follow.
  void Restart(std::span<const Keyframe> at_once);
  // Goes on renewing; to be called once per frame. keyframes: all that were added, in that order.
  void Follow(std::span<const Keyframe> keyframes);

  const OccupancyGrid& grid() const { return grid_; }
  bool renewing() const { return moved_ || next_; }  // some key frames are still in grid() at their old poses

 private:
  OccupancyConfig config_;
  Footprint footprint_;
  OccupancyGrid grid_;
  std::optional<OccupancyGrid> next_;    // with the first entered_ key frames
  std::size_t entered_ = 0, share_ = 0;  // share_: key frames added per call of Follow
  bool moved_ = false;                   // since next_ was begun
};

// The same grid, made at once.
OccupancyGrid GridOf(std::span<const Keyframe> keyframes, const OccupancyConfig& config,
                     const Footprint& footprint = {});

}  // namespace merlin
