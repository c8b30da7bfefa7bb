// A joystick's axes and buttons as what the operator wants: stick to the left steers left, ahead drives ahead, in the
// middle nobody holds it.
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

  // there: the joystick is; without it the hand is off and the wish ages. The autonomy button switches on and off.
  ManualCommand Update(const joystick::State& state, bool there, Time now);

 private:
  HandLimits limits_;
  ManualCommand wish_;
  bool autonomy_was_down_ = true;  // one that is down from the start is no press
};

}  // namespace merlin
