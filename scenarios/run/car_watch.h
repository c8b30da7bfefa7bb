// Detects that a run must end because the car has fallen, tipped over or left the room.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "sim/world/world.h"

namespace merlin {

class CarWatch {
 public:
  // on_turntable: the car is on the turntable, which holds its wheels off the ground.
  CarWatch(const sim::World& world, bool on_turntable);

  // Call after every step.
  void Watch(const sim::World& world);

  // The first reason why the run must end, as a sentence; empty if there is none. The reasons are: no wheel has touched
  // the ground for 0.5 s; the car tilts by more than 45 degrees; it is more than 0.5 m below its start, or more than 1
  // m outside the bounding box of the room.
  const std::string& lost() const { return lost_; }

 private:
  std::string Reason(const sim::World& world) const;

  bool on_turntable_;
  double start_z_m_;
  std::optional<Eigen::AlignedBox2d> room_m_;
  Time on_ground_;  // when a wheel last touched the ground
  std::string lost_;
};

}  // namespace merlin
