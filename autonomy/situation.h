// What a behaviour decides on: everything the stack knows at one depth frame.
//
//   devices -> perception -> slam -> Situation -> behaviour -> Intent -> pilot -> DriveCommand
//
// A Situation is a view: it refers to the observation and the maps of the stack and holds only during the call that it
// is passed to.
#pragma once

#include <optional>

#include "perception/observation.h"
#include "robot/types/se3.h"
#include "robot/types/time.h"
#include "slam/map/occupancy_grid.h"
#include "slam/map/voxel_map.h"

namespace merlin {

struct Situation {
  Time now{0};                     // by the clock; the observation is older, by the latency of the depth camera
  const Observation& observation;  // the newest
  std::optional<Pose> T_map_base;  // at the observation's stamp; none: SLAM has not started. A behaviour always has one
  const VoxelMap& local_map;       // surfaces near the car, in the map frame
  const OccupancyGrid& grid;       // free, occupied and unknown ground, in the map frame
  int lost_frames = 0;             // frames in a row that did not fit the map: the pose is by odometry alone
  bool has_map = true;             // mapping has begun: some frame had points enough
  bool holds_position = true;  // what the newest frame saw holds the position on the floor: it sees more than a floor
  bool searching = false;      // the car searches for its place in the map of an earlier run
  // The map frame has changed with this observation: maps what is remembered in the frame before to the new one. None: it
  // is the same as before.
  std::optional<Pose> T_map_before{};
  bool taken_over = false;  // somebody else has driven since the last decision: plans made before are outdated
};

}  // namespace merlin
