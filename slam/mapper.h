// The map of what was seen: key frames, the maps made of them, and the loops that correct them. A frame becomes a key
// frame once the car has moved far enough. Every so often the mapper searches for a place that it mapped before; where
// it finds one, it lays out all key frames anew (slam/loop/loop_closer.h).
//
//   local map       points of the last metres: each frame is registered against it
//   occupancy grid  free and occupied ground, of all key frames: paths are planned in it
//   whole map       all points, made on demand
//
// All are in the map frame.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "perception/observation.h"
#include "robot/types/footprint.h"
#include "slam/keyframe.h"
#include "slam/loop/loop_closer.h"
#include "slam/map/keyframe_grid.h"
#include "slam/map/voxel_map.h"
#include "slam/saved_map.h"
#include "slam/slam_config.h"

namespace merlin {

class Mapper {
 public:
  Mapper(const SlamConfig& config, const Footprint& footprint)
      : config_(config),
        footprint_(footprint),
        local_(config.local),
        grid_(config.occupancy, footprint),
        closer_(config.loop) {}

  // Adds a frame at a pose that can be trusted; path_m: distance driven until then; yaw_rad: its heading in the map, if
  // it has one. Returns the pose as the loops correct it that this frame closes.
  Pose Add(const Observation& observation, const Pose& T_map_base, double path_m, std::optional<double> yaw_rad);
  // Puts the key frames of a former map before those of this run, and changes to its frame. place: where the frame that
  // was added last is in the former map, in its frame. heading_turn_rad: what is added to the headings of this run.
  void Join(SavedMap former, const Pose& T_former_map, const Loop& place, double heading_turn_rad);
  // Of this frame and of the key frames on the last metres, in this frame's base, thinned: to search a former map with.
  std::vector<Point> RecentPoints(const Observation& observation, const Pose& T_map_base) const;
  // To be called at the end of each frame, added or not: lets go what lies far behind, goes on renewing the grid.
  void EndFrame(double path_m);
  // Searches for loops once more, at every key frame since a former visit was last recognised: a run may end before two
  // searches agreed. Where the whole run closed no loop, its places are searched in all that the drift allows
  // (slam/loop/find_place.h). May take some seconds.
  void Finish();

  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  const VoxelMap& local_map() const { return local_; }
  const OccupancyGrid& occupancy() const { return grid_.grid(); }
  int loops() const { return closer_.loops(); }
  const std::vector<GraphEdge>& loop_edges() const { return closer_.edges(); }

  VoxelMap BuildMap() const;
  OccupancyGrid BuildOccupancy() const { return GridOf(keyframes_, config_.occupancy, footprint_); }

 private:
  void Keep(const Observation& observation, const Pose& T_map_base, std::optional<double> yaw_rad);
  void AddKeyframe(const Observation& observation, const Pose& T_map_base, const Pose& T_previous_base,
                   std::optional<double> yaw_rad);
  void AddView(const Observation& observation, const Pose& T_map_base, Keyframe& keyframe);
  Keyframe* NearestOfFormerVisit(const Pose& T_map_base, double view_yaw_rad);
  std::vector<Point> RecentPoints(std::vector<Point> points_base, std::size_t newest, const Pose& T_map_base,
                                  double path_m, double over_m) const;
  Pose CloseLoop(const Observation& observation, const Pose& T_map_base);
  void SearchWherePoseDrifted();
  void MoveKeyframes(const std::vector<Pose>& corrected);
  void RenewLocalMap();
  void RecallFormerVisit(const Pose& T_map_base);

  SlamConfig config_;
  Footprint footprint_;
  VoxelMap local_;
  KeyframeGrid grid_;
  LoopCloser closer_;
  std::vector<Keyframe> keyframes_;
  Time viewed_at_{0};  // when a frame was last kept, as a key frame or as a view of one
  double path_m_ = 0.0, pruned_at_m_ = 0.0;
};

}  // namespace merlin
