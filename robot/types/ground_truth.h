// What really happened in a run, as plain data: for the judge. A simulation knows it, a real car does not, and the stack
// (perception, slam, autonomy) never sees it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "robot/types/trajectory.h"

namespace merlin {

// Distance [m] from an origin along a unit direction, both in the world's frame, to the nearest true surface, seen from
// either side; infinite if there is none. The room only: without the car.
using TrueRange = std::function<double(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world)>;

struct GroundTruth {
  Trajectory path;                          // T_world_base at the stamps of the depth frames
  std::vector<Eigen::Vector2d> outline_m;   // the room's outer outline, see scenarios/judge/outline.h; may be empty
  std::int64_t collisions = 0;              // episodes of contact between the car and anything else but the ground
  std::optional<double> obstacle_gap_m{};   // least distance to an obstacle; empty: there was none
  std::optional<double> obstacle_stop_s{};  // longest stand while an obstacle was there; empty: the scenario has none
  TrueRange range_m{};                      // never empty
  std::string state_hash{};                 // SHA-256 of the world's state at every step
};

}  // namespace merlin
