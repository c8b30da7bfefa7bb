// A joystick of the Linux kernel (/dev/input/js0), read without waiting. A named pipe with the same events works as
// well: from a joystick on another machine (`ssh there cat /dev/input/js0 > pipe`), or from a recording.
#pragma once

#include <filesystem>

#include "robot/protocol/joystick.h"

namespace merlin {

class JoystickDevice {
 public:
  // Throws MachineError if the device does not exist or cannot be opened, InputError if it is not a joystick.
  explicit JoystickDevice(const std::filesystem::path& device);
  ~JoystickDevice();
  JoystickDevice(const JoystickDevice&) = delete;
  JoystickDevice& operator=(const JoystickDevice&) = delete;

  // Takes the events that have come. False: the joystick is gone (unplugged, or nobody writes to the pipe), and its
  // state is out of date; it is opened again when it is back. A stick that is held still sends nothing, but counts as
  // connected.
  bool Read();
  const joystick::State& state() const { return decoder_.state(); }

 private:
  void Close();

  std::filesystem::path device_;
  int fd_ = -1;
  joystick::Decoder decoder_;
};

}  // namespace merlin
