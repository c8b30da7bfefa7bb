// How far the car can back. No sensor looks behind the car, so that it backs only over ground that the occupancy grid
// knows to be free: what was seen to be free when the car last looked there, and where the car itself has driven
// (OccupancyGrid::Cover). What comes there unseen is not noticed; what is seen there stops the car.
//
// The footprint of the car is swept along the path. Every grid cell that it enters must be free; an occupied or unknown
// cell ends the free ground. Ground below the car is free, since the car stands on it. So is unknown ground close beside
// it, as the grid will have it with the next key frame.
//
//        +--------+---------------+
//        |  gap   |  footprint    |   driven to the left; the gap and the margins on both sides must be free, too
//        +--------+---------------+
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "robot/base/config.h"
#include "robot/types/footprint.h"
#include "robot/types/se3.h"
#include "slam/map/occupancy_grid.h"

namespace merlin {

struct BackConfig {
  double speed_max_m_s = 0.2;  // [0.05, 0.5] the car backs no faster, since it does not see; guess
  double margin_m = 0.03;      // [0, 1] kept free on either side of the car; guess
  double stop_gap_m = 0.15;    // [0.05, 5] kept free behind the car when it stands: map and pose may be off by 0.1 m
};

template <class Visitor>
void Visit(Visitor& v, BackConfig& c) {
  v("speed_max_m_s", c.speed_max_m_s, {0.05, 0.5});
  v("margin_m", c.margin_m, {0.0, 1.0});
  v("stop_gap_m", c.stop_gap_m, {0.05, 5.0});
}

// The length of the path that the car may back along until the gap meets ground that is not known to be free. Nothing: all
// of the path is free; beyond its end nothing was checked.
// path_base: positions of the base's origin, in the base frame and in driving order, from the present one on. The car
// looks against the direction of the path.
std::optional<double> FreeGround_m(const OccupancyGrid& grid, const Footprint& footprint, const Pose& T_map_base,
                                   std::span<const Eigen::Vector2d> path_base, const BackConfig& config);

}  // namespace merlin
