// Joins an emulated device to the program at the other end of a pseudo-terminal, through a line with its timing (a
// cable or the radio). It has no thread: its owner calls Step, about a thousand times a second.
#pragma once

#include <memory>

#include "robot/emulated/channel.h"
#include "robot/emulated/pseudo_terminal.h"
#include "robot/protocol/serial_end.h"

namespace merlin {

class SerialPump {
 public:
  // device and terminal must outlive this object. A program that sets another baud rate than the device's receives and
  // sends garbage.
  SerialPump(PseudoTerminal& terminal, std::unique_ptr<Channel> channel, SerialEnd& device, int baud);

  void Step(Time now);

 private:
  Bytes AsHeard(Bytes bytes) const;

  PseudoTerminal& terminal_;
  std::unique_ptr<Channel> channel_;
  SerialEnd& device_;
  int baud_;
};

}  // namespace merlin
