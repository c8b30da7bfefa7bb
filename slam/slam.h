// Simultaneous localisation and mapping as one sentence: guess, register, keep key frames, close loops, map.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "perception/observation.h"
#include "robot/types/footprint.h"
#include "slam/keyframe.h"
#include "slam/loop/loop_closer.h"
#include "slam/map/keyframe_grid.h"
#include "slam/map/voxel_map.h"
#include "slam/register/icp.h"

namespace merlin {

struct SlamConfig {
  VoxelMapConfig local;  // the map a frame is registered against
  IcpConfig icp;
  OccupancyConfig occupancy;
  LoopConfig loop;
  double source_voxel_m = 0.08;  // [0.005, 1] frames are thinned to one point a voxel of this edge before registration
  double local_length_m = 8.0;   // [0.5, 1000] driven length after which an unseen voxel leaves the local map
  double keyframe_distance_m = 0.1;  // [0, 10]
  double keyframe_angle_rad = 0.08;  // [0, 3.2]
  double revisit_m = 0.5;            // [0, 10] where the map is known already, a former key frame this near...
  double revisit_rad = 0.4;          // [0, 3.2] ...and so turned saves a new one
  double correction_min_m = 0.005;   // [0, 1] a loop that moves no key frame farther leaves the map as it is
  double odometry_share = 0.02;      // [1e-4, 1] one sigma of odometry over the way driven; guess
  double slip_min =
      0.08;  // [0.01, 1] of the way that registration takes back: the wheels slip, and are believed less; guess
  double slip_memory_m = 0.3;       // [0.01, 10] driven over which that is averaged; guess
  double odometry_floor_m = 0.001;  // [1e-5, 1] and at least; guess
  double yaw_floor_rad = 0.003;     // [1e-5, 1] the heading's sigma is not believed below this; guess
  double floor_sigma_m = 0.002;     // [1e-4, 10] the car stays on a plane: height...
  double tilt_sigma_rad =
      0.001;               // [1e-4, 3] ...roll and pitch. At 0.01 and 0.005 the map slowly climbed: 1 % too short
  double restart_s = 3.0;  // [0.1, 1e6] lost so long while it stands, it maps on from where odometry left it
  double start_sigma_rad = 0.004;  // [1e-4, 10] mapping waits until the heading is known this well,...
  double start_wait_s = 2.0;       // [0, 100] ...but no longer than this
  double map_voxel_m = 0.04;       // [0.005, 1] of the map that is written
  int map_points_min = 2;          // [1, 1000] points a voxel of it needs
};

template <class Visitor>
void Visit(Visitor& v, SlamConfig& c) {
  v("local", c.local);
  v("icp", c.icp);
  v("occupancy", c.occupancy);
  v("loop", c.loop);
  v("source_voxel_m", c.source_voxel_m, {0.005, 1.0});
  v("local_length_m", c.local_length_m, {0.5, 1000.0});
  v("keyframe_distance_m", c.keyframe_distance_m, {0.0, 10.0});
  v("keyframe_angle_rad", c.keyframe_angle_rad, {0.0, 3.2});
  v("revisit_m", c.revisit_m, {0.0, 10.0});
  v("revisit_rad", c.revisit_rad, {0.0, 3.2});
  v("correction_min_m", c.correction_min_m, {0.0, 1.0});
  v("odometry_share", c.odometry_share, {1e-4, 1.0});
  v("slip_min", c.slip_min, {0.01, 1.0});
  v("slip_memory_m", c.slip_memory_m, {0.01, 10.0});
  v("odometry_floor_m", c.odometry_floor_m, {1e-5, 1.0});
  v("yaw_floor_rad", c.yaw_floor_rad, {1e-5, 1.0});
  v("floor_sigma_m", c.floor_sigma_m, {1e-4, 10.0});
  v("tilt_sigma_rad", c.tilt_sigma_rad, {1e-4, 3.0});
  v("restart_s", c.restart_s, {0.1, 1e6});
  v("start_sigma_rad", c.start_sigma_rad, {1e-4, 10.0});
  v("start_wait_s", c.start_wait_s, {0.0, 100.0});
  v("map_voxel_m", c.map_voxel_m, {0.005, 1.0});
  v("map_points_min", c.map_points_min, {1.0, 1000.0});
}

struct MapPose {
  Time stamp{0};
  Pose T_map_base = Pose::Identity();
};

class Slam {
 public:
  // Where the footprint went nothing stands any more; without one nothing is taken from that.
  explicit Slam(const SlamConfig& config, const Footprint& footprint = {});

  // The pose at the observation's stamp; nothing while mapping waits for the heading to settle at the start.
  // The map frame: origin where mapping began, axes along the world's as the compass has them, or, where it has none at
  // the start, along the car's. Nothing for an odometry that is not finite.
  std::optional<Pose> Update(const Observation& observation);

  const RegisterResult& last() const { return last_; }  // how well the last frame fitted
  // Frames in a row that did not: odometry carried the pose, and nothing of them entered the map.
  int lost_frames() const { return lost_frames_; }
  // Registration takes back (or adds) this share of the way that the wheels report, of late.
  bool slipping() const { return std::abs(slip_) > config_.slip_min; }
  const VoxelMap& local_map() const { return local_; }
  // A closed loop corrects poses, key frames and the local map at once. The grid follows later, so that no frame takes long:
  // it shows former key frames where they were believed before for up to 40 frames (KeyframeGrid::kFrames; 2 s at 20 Hz),
  // and up to 80 where the next loop is closed meanwhile. New key frames are in it at once.
  const OccupancyGrid& occupancy() const { return grid_.grid(); }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  const std::vector<MapPose>& online() const { return online_; }  // one pose a frame, as the car drove by it
  std::vector<MapPose> trajectory() const;                        // the same frames, as the closed loops correct them
  double path_m() const { return path_m_; }
  int loops() const { return closer_.loops(); }  // that join two key frames

  // The whole map, from all key frames, coloured: without what moved away. Of its voxels those with at least map_points_min
  // points are meant to be used.
  VoxelMap BuildMap() const;
  // The whole grid, from all key frames as the closed loops correct them.
  OccupancyGrid BuildOccupancy() const { return GridOf(keyframes_, config_.occupancy); }

 private:
  PosePrior Predict(const Observation& observation) const;
  bool Begin(const Observation& observation);  // false: it waits for the heading
  void Keep(const Observation& observation, const Pose& T_map_base);
  void Watch(const Observation& observation, const Pose& T_map_base, Keyframe& keyframe);
  void Record(Time stamp, const Pose& T_map_base);
  void WatchWheels(const Pose& motion, const Pose& T_prior_registered);
  bool GivesUp(Time stamp, bool stands);
  Keyframe* FormerVisit(const Pose& T_map_base);
  void RecallFormer(const Pose& T_map_base);
  void SearchLoop(const Observation& observation, Pose& T_map_base);
  void Correct(const std::vector<Pose>& corrected);
  std::vector<Point> SeenOfLate(const Observation& observation, const Pose& T_map_base) const;

  // A frame's pose, from the key frame it hangs on; before the first one none, and from the map.
  struct Step {
    std::optional<std::size_t> keyframe;
    Pose T_keyframe_base;
  };

  SlamConfig config_;
  Footprint footprint_;
  VoxelMap local_;
  KeyframeGrid grid_;
  LoopCloser closer_;
  std::vector<Keyframe> keyframes_;
  std::vector<MapPose> online_;
  std::vector<Step> steps_;         // of the online poses
  std::optional<Pose> T_map_last_;  // the newest, as corrected
  RegisterResult last_;
  int lost_frames_ = 0;
  double path_m_ = 0.0, pruned_at_m_ = 0.0, slip_ = 0.0;
  Time sighted_at_{0};
  std::optional<Time> first_stamp_;
  std::optional<Time> lost_standing_;   // since then
  std::optional<double> map_turn_rad_;  // yaw in the map less the heading's
  Pose T_odom_last_ = Pose::Identity();
};

}  // namespace merlin
