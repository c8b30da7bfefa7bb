// The devices of an emulated car, as a hardware file names those of a real one.
#pragma once

#include <filesystem>

#include "robot/emulated/emulated_robot.h"
#include "robot/hardware/hardware_robot.h"

namespace merlin {

// A folder of this program's own for the devices' sockets, gone with it.
class SocketFolder {
 public:
  SocketFolder();  // throws MachineError
  ~SocketFolder();
  SocketFolder(const SocketFolder&) = delete;
  SocketFolder& operator=(const SocketFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// The ToF camera's library is the one this program was built with; MERLIN_PMD_LIBRARY names another.
HardwareConfig DevicesOf(const EmulatedRobot& emulated);

}  // namespace merlin
