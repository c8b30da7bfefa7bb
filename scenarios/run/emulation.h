// The car of a scenario with all its devices emulated (robot/emulated/), and the ground truth.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/emulated/emulated_robot.h"
#include "robot/hardware/hardware_robot.h"
#include "scenarios/run/run.h"
#include "scenarios/run/truth.h"

namespace merlin {

// A temporary folder for the sockets of the devices, removed with this object.
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

class Emulation {
 public:
  // The devices answer from here on. Of the options scenario, gl and threads count. clock must outlive this object.
  // Throws like the twin's plug, and InputError for a task that only the twin can do.
  Emulation(const RunOptions& options, const Clock& clock);

  EmulatedRobot& robot() { return *robot_; }
  // The devices in the form of a hardware file. The library of the ToF camera is that of this build, unless the
  // environment variable MERLIN_PMD_LIBRARY names another.
  HardwareConfig Devices() const;
  // The cameras of the scenario, without colour if this machine cannot draw.
  const HardwareCameras& cameras() const { return cameras_; }
  const std::string& renderer() const { return renderer_; }  // empty without colour
  // What the user should know, one sentence each.
  std::vector<std::string> Notes() const;

  // Calls use(truth, world) while the simulation is paused. Rethrows an exception that has ended the simulation.
  template <class Use>
  auto WithTruth(const Use& use) {
    if (const std::exception_ptr failure = robot_->failure()) std::rethrow_exception(failure);
    return robot_->With([&](Twin& twin) { return use(*truth_, std::as_const(twin).world()); });
  }

 private:
  SocketFolder sockets_;
  std::string car_;
  HardwareCameras cameras_;
  std::optional<Truth> truth_;  // declared before robot_, whose thread uses it until it ends
  std::unique_ptr<EmulatedRobot> robot_;
  std::string renderer_;
  std::vector<std::string> notes_;
};

}  // namespace merlin
