// Turns the axes and buttons of a joystick into manual commands. Stick to the left: steers left; forwards: drives forwards; in
// the middle: nobody steers.
#pragma once

#include "autonomy/arbitrate.h"
#include "robot/protocol/joystick.h"
#include "tools/drive/hand.h"

namespace merlin {

class Stick {
 public:
  static constexpr std::size_t kSteeringAxis = 0, kSpeedAxis = 1;
  static constexpr std::size_t kOverrideButton = 0, kAutonomyButton = 1, kQuitButton = 7;  // 7: "start" of most pads
  static constexpr double kDeadZone = 0.12;  // of full travel: worn springs; guess

  explicit Stick(const HandLimits& limits) : limits_(limits) {}

  // there: whether the joystick is connected. If not, nobody steers, and the command keeps the time at which the joystick was
  // last heard. Each press of the autonomy button switches autonomy on or off.
  ManualCommand Update(const joystick::State& state, bool there, Time now);

 private:
  HandLimits limits_;
  ManualCommand wish_;
  bool autonomy_was_down_ = true;  // a button that is down from the start does not count as pressed
};

}  // namespace merlin
