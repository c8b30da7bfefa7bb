// The loop's ears: polls every device once a tick, and knows when each was last heard.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "robot/hal/hal.h"
#include "scenarios/run/loop_state.h"

namespace merlin {

// Uses a device. Whatever its driver throws becomes a DeviceError that names the device.
template <class Use>
auto UseDevice(const std::string& device, const Use& use) {
  try {
    return use();
  } catch (const std::exception& error) {
    throw DeviceError(device + ": " + error.what());
  } catch (...) {
    throw DeviceError(device + ": its driver threw an unknown exception");
  }
}

class Ears {
 public:
  // The robot's devices count as heard now.
  explicit Ears(const Robot& robot);

  // Everything that has arrived since the last call, and how each device is. Throws DeviceError.
  void Hear(LoopState::Heard& heard);
  const std::vector<SupervisedDevice>& devices() const { return devices_; }
  // One that the robot has.
  const SupervisedDevice& Of(const std::string& name) const;

 private:
  template <class Device, class Take>
  void Poll(const std::string& name, Device* device, const Take& take);

  Robot robot_;
  std::vector<SupervisedDevice> devices_;
};

}  // namespace merlin
