// Sends the operator's commands through the model of MERLIN's modems (robot/emulated/radio.h): in sevenths of the
// limits, late, and sometimes not at all.
#pragma once

#include <cstdint>

#include "autonomy/arbitrate.h"
#include "robot/emulated/radio.h"
#include "robot/protocol/operator.h"
#include "tools/drive/hand.h"

namespace merlin {

class RadioHand {
 public:
  RadioHand(const RadioConfig& config, const HandLimits& limits, std::uint64_t seed)
      : radio_(config, seed), limits_(limits) {}

  // at_station: the operator's present command. A station whose joystick is disconnected sends nothing. Returns what
  // the car heard last, with the time at which it heard it. A request to quit does not go through the radio.
  ManualCommand Send(const ManualCommand& at_station, Time now);

 private:
  Radio radio_;
  HandLimits limits_;
  operator_link::Decoder decoder_;
  std::uint8_t sequence_ = 0;
  ManualCommand heard_{.heard = Time(-std::chrono::hours(1))};  // nothing heard yet
};

}  // namespace merlin
