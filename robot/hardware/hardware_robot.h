// The real car: all its drivers, each made from its own config.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot/hal/hal.h"
#include "robot/hardware/color/color_camera_driver.h"
#include "robot/hardware/compass/compass_3dm_driver.h"
#include "robot/hardware/depth/tof_camera_driver.h"
#include "robot/hardware/drive/microcontroller_drive.h"
#include "robot/hardware/real_clock.h"

namespace merlin {

// Where each device is: the contents of the file that `--robot hardware:FILE` names.
struct HardwareConfig {
  std::string car;  // the car that these devices belong to, by the name in its description; empty: any
  RealClockConfig clock;
  MicrocontrollerConfig drive;
  std::optional<Compass3dmConfig> compass;  // absent: the car has none
  TofCameraConfig depth;
  std::optional<ColorCameraConfig> color;
};

template <class Visitor>
void Visit(Visitor& v, HardwareConfig& c) {
  v("car", c.car);
  v("clock", c.clock);
  v("drive", c.drive);
  v("compass", c.compass);
  v("depth", c.depth);
  v("color", c.color);
}

// The cameras and their first settings.
struct HardwareCameras {
  DepthCameraInfo depth;
  DepthSettings depth_settings;
  std::optional<ColorCameraInfo> color{};
  ColorSettings color_settings{};
};

class HardwareRobot {
 public:
  // Opens every device. Throws InputError or MachineError, one sentence, for the first one that cannot be used; nothing
  // has moved then. If the stack stalls, the clock's watchdog brakes the car. clock must outlive this object.
  HardwareRobot(const HardwareConfig& config, const HardwareCameras& cameras, RealClock& clock);
  ~HardwareRobot();

  Robot robot();
  // Waits until every device has delivered, at most for limit. Returns what is wrong with each device that has not, one
  // sentence each.
  std::vector<std::string> WaitUntilReady(Duration limit);
  // What is wrong now with each device that is not well, one sentence each.
  std::vector<std::string> Complaints() const;

 private:
  RealClock& clock_;
  MicrocontrollerDrive drive_;
  std::optional<Compass3dmDriver> compass_;
  std::optional<TofCameraDriver> depth_;
  std::optional<ColorCameraDriver> color_;
};

// One device: opened, listened to, closed again.
struct DeviceReport {
  std::string device;     // "drive", "compass", "depth camera", "colour camera"
  std::string complaint;  // one sentence; empty: it works
  // kBadConfig: the config is wrong, not the device.
  enum class Fault { kNone, kSilent, kNotOpened, kBadConfig } fault = Fault::kNone;

  bool works() const { return fault == Fault::kNone; }
};
// For `merlin doctor`: checks every device by itself, so that all faults are reported, not only the first. Moves
// nothing.
std::vector<DeviceReport> CheckDevices(const HardwareConfig& config, const HardwareCameras& cameras, Duration listen);

}  // namespace merlin
