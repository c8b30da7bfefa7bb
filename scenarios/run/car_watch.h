// Sees when a run has come to its end because the car is no longer where or how a car drives.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "sim/world/world.h"

namespace merlin {

class CarWatch {
 public:
  // on_turntable: the car stands on the turntable, where its wheels are to touch nothing.
  CarWatch(const sim::World& world, bool on_turntable);

  // After every step.
  void Watch(const sim::World& world);

  // The first reason why the run must end, a sentence; empty: none. No wheel has touched the ground for 0.5 s; the car
  // tilts by more than 45 degrees; it is more than 0.5 m below its start; it is more than 1 m outside the room's box.
  const std::string& lost() const { return lost_; }

 private:
  std::string Reason(const sim::World& world) const;

  bool on_turntable_;
  double start_z_m_;
  std::optional<Eigen::AlignedBox2d> room_m_;
  Time on_ground_;  // when a wheel last touched it
  std::string lost_;
};

}  // namespace merlin
