// What really happened: watches the simulated world for the judge. The stack never sees it.
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

  // After every step: counts contacts, hashes the state, watches over the car.
  void Watch(const sim::World& world);
  // Keeps the true pose at a stamp of the last second, between two steps if need be.
  void Keep(Time stamp);

  const Trajectory& trajectory() const { return trajectory_; }
  int collisions() const { return collisions_; }
  // Why the run must end; empty: nothing of the kind.
  const std::string& car_lost() const { return car_.lost(); }
  std::string state_hash() const { return state_.Hex(); }
  std::optional<double> obstacle_gap_m() const { return obstacle_gap_m_; }
  // Of actors, too. Longest time in a row that the car stood while one was there; empty without any.
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
