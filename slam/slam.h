// Simultaneous localisation and mapping, as one sentence: each frame is localised in the map, added to it where its
// pose can be trusted, and recorded on the trajectory (slam/localizer.h, slam/mapper.h). Key frames and closed loops
// follow F. Lu and E. Milios, "Globally consistent range scan alignment for environment mapping", Autonomous Robots 4,
// 1997.
//
//   in   Observation     points, wheel odometry and heading of one depth frame (perception/observation.h)
//   out  T_map_base      the car's pose at the frame's stamp
//        maps            local map, occupancy grid, whole map
//        trajectory      one pose a frame
#pragma once

#include <optional>
#include <vector>

#include "perception/observation.h"
#include "robot/types/footprint.h"
#include "slam/keyframe.h"
#include "slam/localizer.h"
#include "slam/mapper.h"
#include "slam/slam_config.h"

namespace merlin {

struct MapPose {
  Time stamp{0};
  Pose T_map_base = Pose::Identity();
};

class Slam {
 public:
  // footprint: the car's. Where it drove nothing can still be in the map; an empty one clears nothing.
  explicit Slam(const SlamConfig& config, const Footprint& footprint = {})
      : localizer_(config), mapper_(config, footprint) {}

  // The pose at the observation's stamp. Nothing while mapping waits for the heading to settle at the start, and for an
  // odometry that is not finite. Map frame: see slam/localizer.h.
  std::optional<Pose> Update(const Observation& observation);

  const RegisterResult& last() const { return localizer_.last(); }  // how well the last frame fitted
  // Frames in a row that did not fit: odometry carried the pose, and nothing of them entered the map.
  int lost_frames() const { return localizer_.lost_frames(); }
  // Registration takes back, or adds, a good share of the distance that the wheels reported last.
  bool slipping() const { return localizer_.slipping(); }
  double path_m() const { return localizer_.path_m(); }  // distance driven

  const VoxelMap& local_map() const { return mapper_.local_map(); }
  // A closed loop corrects poses, key frames and the local map at once. The grid follows later, so that no frame takes
  // long: former key frames stay where they were for up to 40 frames (KeyframeGrid::kFrames; 2 s at 20 Hz), and for up
  // to 80 where the next loop is closed meanwhile. New key frames are in it at once.
  const OccupancyGrid& occupancy() const { return mapper_.occupancy(); }
  const std::vector<Keyframe>& keyframes() const { return mapper_.keyframes(); }
  int loops() const { return mapper_.loops(); }  // closed so far

  const std::vector<MapPose>& online() const { return online_; }  // one pose a frame, as the car drove by it
  std::vector<MapPose> trajectory() const;                        // the same frames, as the closed loops correct them

  // The whole map, from all key frames, coloured; what moved away is left out. Use its voxels with at least
  // map_points_min points.
  VoxelMap BuildMap() const { return mapper_.BuildMap(); }
  // The whole grid, from all key frames as the closed loops correct them.
  OccupancyGrid BuildOccupancy() const { return mapper_.BuildOccupancy(); }

 private:
  // A frame's pose from the newest key frame there was; from the map where there was none.
  struct Step {
    std::optional<std::size_t> keyframe;
    Pose T_keyframe_base;
  };

  void Record(Time stamp, const Pose& T_map_base);

  Localizer localizer_;
  Mapper mapper_;
  std::vector<MapPose> online_;
  std::vector<Step> steps_;  // of the online poses
};

}  // namespace merlin
