#include "robot/hardware/hardware_robot.h"

#include <exception>
#include <functional>
#include <thread>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr auto kLook = std::chrono::milliseconds(20);

const char* Name(DeviceStatus::Health health) {
  switch (health) {
    case DeviceStatus::Health::kOk:
      return "ok";
    case DeviceStatus::Health::kSilent:
      return "silent: it is connected but sends nothing";
    case DeviceStatus::Health::kFaulty:
      return "faulty: what it sends cannot be read (another baud rate or device?)";
    default:
      return "absent";
  }
}

// What is wrong with a device; empty: nothing.
std::string Complaint(const std::string& device, const DeviceStatus& status, const std::string& own = "") {
  if (status.health == DeviceStatus::Health::kOk) return "";
  return device + ": " + (own.empty() ? Name(status.health) : own);
}

// Polls until ready, at most until the limit. It waits in real time, which the devices' threads need.
bool WaitFor(const RealClock& clock, Duration limit, const std::function<bool()>& ready) {
  for (const Time end = clock.Now() + limit; !ready();) {
    if (clock.Now() >= end) return false;
    std::this_thread::sleep_for(kLook);
  }
  return true;
}

}  // namespace

HardwareRobot::HardwareRobot(const HardwareConfig& config, const HardwareCameras& cameras, RealClock& clock)
    : clock_(clock), drive_(config.drive, clock) {
  if (config.compass) compass_.emplace(*config.compass, clock);
  depth_.emplace(config.depth, cameras.depth, cameras.depth_settings, clock);
  if (config.color && cameras.color) color_.emplace(*config.color, *cameras.color, cameras.color_settings, clock);
  clock_.OnStall([this] { drive_.Send({.speed_m_s = 0.0, .steering_rad = 0.0, .valid_for = Duration(0)}); });
}

HardwareRobot::~HardwareRobot() { clock_.OnStall({}); }

Robot HardwareRobot::robot() {
  return {.clock = &clock_,
          .depth = &*depth_,
          .color = color_ ? &*color_ : nullptr,
          .compass = compass_ ? &*compass_ : nullptr,
          .drive = &drive_,
          .pan = drive_.pan().Status().health == DeviceStatus::Health::kAbsent ? nullptr : &drive_.pan()};
}

std::vector<std::string> HardwareRobot::WaitUntilReady(Duration limit) {
  bool depth = false, color = !color_;
  WaitFor(clock_, limit, [&] {
    depth |= depth_->Poll().has_value();
    if (color_) color |= color_->Poll().has_value();
    const bool compass = !compass_ || compass_->Status().health == DeviceStatus::Health::kOk;
    return depth && color && compass && drive_.Status().health == DeviceStatus::Health::kOk;
  });
  std::vector<std::string> complaints;
  const auto add = [&](const std::string& complaint) {
    if (!complaint.empty()) complaints.push_back(complaint);
  };
  add(Complaint("drive", drive_.Status(), drive_.Complaint()));
  if (compass_) add(Complaint("compass", compass_->Status(), compass_->Complaint()));
  if (const std::string own = depth_->Complaint(); !depth)
    add("depth camera: no frame came" + (own.empty() ? "" : ": " + own));
  if (!color) add("colour camera: no picture came");
  return complaints;
}

std::vector<std::string> HardwareRobot::Complaints() const {
  std::vector<std::string> complaints{Complaint("drive", drive_.Status(), drive_.Complaint()),
                                      Complaint("depth camera", depth_->Status(), depth_->Complaint())};
  if (compass_) complaints.push_back(Complaint("compass", compass_->Status(), compass_->Complaint()));
  if (color_) complaints.push_back(Complaint("colour camera", color_->Status()));
  std::erase(complaints, "");
  return complaints;
}

std::vector<DeviceReport> CheckDevices(const HardwareConfig& config, const HardwareCameras& cameras, Duration listen) {
  RealClock clock(config.clock, Time::max());
  std::vector<DeviceReport> reports;
  const auto check = [&](const char* device, const std::function<std::string()>& use) {
    using enum DeviceReport::Fault;
    try {
      const std::string complaint = use();
      reports.push_back({device, complaint, complaint.empty() ? kNone : kSilent});
    } catch (const InputError& error) {
      reports.push_back({device, std::string(device) + ": " + error.what(), kBadConfig});
    } catch (const std::exception& error) {
      reports.push_back({device, std::string(device) + ": " + error.what(), kNotOpened});
    }
  };
  check("drive", [&] {
    MicrocontrollerDrive drive(config.drive, clock);
    WaitFor(clock, listen, [&] { return drive.Status().health == DeviceStatus::Health::kOk; });
    return Complaint("drive", drive.Status(), drive.Complaint());
  });
  if (config.compass)
    check("compass", [&] {
      Compass3dmDriver compass(*config.compass, clock);
      WaitFor(clock, listen, [&] { return compass.Status().health == DeviceStatus::Health::kOk; });
      return Complaint("compass", compass.Status(), compass.Complaint());
    });
  check("depth camera", [&]() -> std::string {
    TofCameraDriver camera(config.depth, cameras.depth, cameras.depth_settings, clock);
    return WaitFor(clock, listen, [&] { return camera.Poll().has_value(); }) ? "" : "depth camera: no frame came";
  });
  if (config.color && cameras.color)
    check("colour camera", [&]() -> std::string {
      ColorCameraDriver camera(*config.color, *cameras.color, cameras.color_settings, clock);
      return WaitFor(clock, listen, [&] { return camera.Poll().has_value(); }) ? "" : "colour camera: no picture came";
    });
  return reports;
}

}  // namespace merlin
