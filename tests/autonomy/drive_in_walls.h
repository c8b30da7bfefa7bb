// The closed loop of the autonomy tests without a simulation: a kinematic car in a room of walls that the map knows.
#pragma once

#include <vector>

#include "autonomy/pilot.h"
#include "tests/autonomy/toy_car.h"
#include "tests/autonomy/walls.h"

namespace merlin {

constexpr double kFrame_s = 0.05;

// The car in a map; what it sees is what is ahead of it.
class DriveInWalls {
 public:
  explicit DriveInWalls(const Walls& walls) : walls_(walls), map_(walls.Map()), grid_(walls.Grid()) {}

  Situation Now(int lost_frames = 0, bool taken_over = false) {
    observation_.stamp = FromSeconds(1.0 + kFrame_s * frames_);
    observation_.T_odom_base = car.T_map_base();
    observation_.points_base.clear();
    const Eigen::Isometry3f T_base_plan = (car.T_map_base().inverse() * walls_.T_map_plan()).cast<float>();
    for (Point point : walls_.points_plan()) {
      point.position = T_base_plan * point.position;
      if (point.position.x() > std::abs(point.position.y())) observation_.points_base.push_back(point);
    }
    return {.now = observation_.stamp,
            .observation = observation_,
            .T_map_base = car.T_map_base(),
            .local_map = map_,
            .grid = grid_,
            .lost_frames = lost_frames,
            .taken_over = taken_over};
  }
  // Drives with the pilot for this many frames, and returns what it did, without repetitions.
  std::vector<Activity> Drive(Pilot& pilot, int frames) {
    std::vector<Activity> activities;
    for (int i = 0; i < frames; ++i) {
      decision = pilot.Decide(Now());
      if (activities.empty() || activities.back() != decision.activity) activities.push_back(decision.activity);
      car.Drive(decision.command, kFrame_s);
      ++frames_;
    }
    return activities;
  }

  ToyCar car;
  Decision decision;  // the last one

 private:
  Walls walls_;
  VoxelMap map_;
  OccupancyGrid grid_;
  Observation observation_;
  int frames_ = 0;
};

}  // namespace merlin
