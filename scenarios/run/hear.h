// Polls every device once per tick and records when each was last heard.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "robot/hal/hal.h"
#include "scenarios/run/loop_state.h"

namespace merlin {

// Calls use(). Whatever the driver throws becomes a DeviceError that names the device.
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
  // All devices of the robot count as heard at this time.
  explicit Ears(const Robot& robot);

  // Collects everything that has arrived since the last call and updates devices(). Throws DeviceError.
  void Hear(LoopState::Heard& heard);
  const std::vector<SupervisedDevice>& devices() const { return devices_; }
  // The device of this name, which the robot must have.
  const SupervisedDevice& Of(const std::string& name) const;

 private:
  template <class Device, class Take>
  void Poll(const std::string& name, Device* device, const Take& take);

  Robot robot_;
  std::vector<SupervisedDevice> devices_;
};

}  // namespace merlin
