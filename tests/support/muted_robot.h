// A robot whose devices can be silenced: later measurements are dropped, and the status stays what it was. The owner of
// the devices must outlive this.
#pragma once

#include <optional>

#include "robot/hal/hal.h"

namespace merlin {

template <class Device, class Measurement>
class Muted : public Device {
 public:
  explicit Muted(Device* device) : device_(device) {}
  std::optional<Measurement> Poll() override {
    auto measurement = device_->Poll();
    return muted ? std::nullopt : measurement;
  }
  DeviceStatus Status() const override { return status ? *status : device_->Status(); }

  bool muted = false;
  std::optional<DeviceStatus> status;  // reported instead of the device's own

 protected:
  Device* device_;
};

struct MutedDepth final : Muted<DepthCamera, DepthFrame> {
  using Muted::Muted;
  const DepthCameraInfo& Info() const override { return device_->Info(); }
  void Configure(const DepthSettings& settings) override { device_->Configure(settings); }
};

struct MutedDrive final : Muted<Drive, DriveState> {
  using Muted::Muted;
  void Send(const DriveCommand& command) override { device_->Send(command); }
};

using MutedCompass = Muted<Compass, CompassReading>;

struct MutedRobot {
  explicit MutedRobot(const Robot& robot)
      : robot_(robot), depth(robot.depth), drive(robot.drive), compass(robot.compass) {}
  Robot robot() {
    Robot muted = robot_;
    muted.depth = &depth, muted.drive = &drive;
    if (robot_.compass != nullptr) muted.compass = &compass;
    return muted;
  }

 private:
  Robot robot_;

 public:
  MutedDepth depth;
  MutedDrive drive;
  MutedCompass compass;
};

}  // namespace merlin
