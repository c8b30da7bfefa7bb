// Settings of SLAM. Each field has its range, its effect and where its value comes from.
#pragma once

#include "robot/base/config.h"
#include "slam/loop/find_loop.h"
#include "slam/map/occupancy_grid.h"
#include "slam/map/voxel_map.h"
#include "slam/register/icp.h"

namespace merlin {

// The search for the car's place in the map of an earlier run (slam/place_search.h).
struct SearchConfig {
  double every_m = 0.25;     // [0.01, 10] distance driven between two searches...
  double every_rad = 0.3;    // [0.01, 3.2] ...or turn
  double heading_rad = 0.4;  // [0.01, 3.2] a place may contradict the compass by this much; steel bends it so far
  int agreeing_min = 4;      // [1, 100] searches in a row must lead to the same place
  double agreeing_m = 0.15;  // [0.001, 10] within this distance, and the same number of rad
  double give_up_m = 15.0;   // [0.1, 1000] distance after which the car does not know the place: a long room's length
  double give_up_s = 60.0;   // [1, 1e5] the same as a time: as long as that distance takes
};

template <class Visitor>
void Visit(Visitor& v, SearchConfig& c) {
  v("every_m", c.every_m, {0.01, 10.0});
  v("every_rad", c.every_rad, {0.01, 3.2});
  v("heading_rad", c.heading_rad, {0.01, 3.2});
  v("agreeing_min", c.agreeing_min, {1.0, 100.0});
  v("agreeing_m", c.agreeing_m, {0.001, 10.0});
  v("give_up_m", c.give_up_m, {0.1, 1000.0});
  v("give_up_s", c.give_up_s, {1.0, 1e5});
}

struct SlamConfig {
  VoxelMapConfig local;  // the map that each frame is registered against
  IcpConfig icp;
  OccupancyConfig occupancy;
  LoopConfig loop;
  SearchConfig search;

  // Localisation: the guess that registration starts from, and how far it is trusted.
  double source_voxel_m = 0.08;     // [0.005, 1] registration gets one point of the frame per voxel of this edge
  int source_points_min = 200;      // [0, 1e6] ...or of a smaller edge, so that it gets at least so many; guess
  double odometry_share = 0.02;     // [1e-4, 1] one sigma of odometry, as a share of the distance driven; guess
  double odometry_floor_m = 0.001;  // [1e-5, 1] added to that sigma; guess
  double slip_min = 0.08;           // [0.01, 1] the wheels count as slipping from this share of slip on; guess
  double slip_memory_m = 0.3;       // [0.01, 10] distance over which the slip is averaged; guess
  double yaw_floor_rad = 0.003;     // [1e-5, 1] lower bound for the sigma of the heading; guess
  double floor_sigma_m = 0.002;     // [1e-4, 10] one sigma of the height: the car stays on a plane
  double tilt_sigma_rad = 0.001;    // [1e-4, 3] of roll and pitch; at 0.005 the map climbed slowly, and was 1 % short
  double restart_s = 3.0;           // [0.1, 1e6] a lost car that has not moved for so long maps on from its odometry
  double start_sigma_rad = 0.004;   // [1e-4, 10] mapping waits until the heading is known to this sigma,...
  double start_wait_s = 2.0;        // [0, 100] ...but no longer than this

  // Mapping: key frames and maps.
  double local_length_m = 8.0;       // [0.5, 1000] a voxel not seen for this distance leaves the local map
  double keyframe_distance_m = 0.1;  // [0, 10] a new key frame is taken after this distance...
  double keyframe_angle_rad = 0.08;  // [0, 3.2] ...or this turn
  double revisit_m = 0.5;            // [0, 10] in a place that was recognised, no new key frame is taken this near...
  double revisit_rad = 0.4;          // [0, 3.2] ...to a former one that points within this angle
  double correction_min_m = 0.005;   // [0, 1] a loop that moves no key frame farther leaves the map as it is
  double map_voxel_m = 0.04;         // [0.005, 1] of the map that is written
  int map_points_min = 2;            // [1, 1000] points that a voxel of it needs
};

template <class Visitor>
void Visit(Visitor& v, SlamConfig& c) {
  v("local", c.local);
  v("icp", c.icp);
  v("occupancy", c.occupancy);
  v("loop", c.loop);
  v("search", c.search);
  v("source_voxel_m", c.source_voxel_m, {0.005, 1.0});
  v("source_points_min", c.source_points_min, {0.0, 1e6});
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

}  // namespace merlin
