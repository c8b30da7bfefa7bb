// Records the ground truth of a simulated run for the judge. The stack never sees it.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "robot/base/sha256.h"
#include "robot/types/trajectory.h"
#include "scenarios/config/scenario.h"
#include "scenarios/run/car_watch.h"
#include "sim/world/world.h"

namespace merlin {

class Truth {
 public:
  Truth(const Scenario& scenario, const sim::World& world);

  // Call after every step: counts contacts, hashes the state, and checks whether the car is lost.
  void Watch(const sim::World& world);
  // Appends the true pose at a stamp within the last second to the trajectory, interpolated between steps.
  void Keep(Time stamp);

  const Trajectory& trajectory() const { return trajectory_; }
  int collisions() const { return collisions_; }
  // Why the run must end; empty if it need not.
  const std::string& car_lost() const { return car_.lost(); }
  std::string state_hash() const { return state_.Hex(); }
  std::optional<double> obstacle_gap_m() const { return obstacle_gap_m_; }
  // Longest uninterrupted time that the car stood while an obstacle or actor was present; none without any.
  std::optional<double> obstacle_stop_s() const { return obstacle_stop_s_; }

 private:
  void WatchActors(const sim::World& world);

  CarWatch car_;
  std::deque<StampedPose> recent_;
  Trajectory trajectory_;
  Sha256 state_;
  int collisions_ = 0;
  std::optional<Time> last_touch_;
  std::optional<double> obstacle_gap_m_, obstacle_stop_s_;
  double standing_s_ = 0.0;
};

}  // namespace merlin
