// The car of a scenario, emulated device by device (robot/emulated/), and the truth about it.
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

class Emulation {
 public:
  // The devices answer from now on. options: the scenario, gl, threads. clock outlives this. Throws as the twin's plug
  // does, and InputError for a task that only the twin itself can do.
  Emulation(const RunOptions& options, const Clock& clock);

  EmulatedRobot& robot() { return *robot_; }
  // As a hardware file names them. The ToF camera's library is the one this program was built with; the environment's
  // MERLIN_PMD_LIBRARY names another.
  HardwareConfig Devices() const;
  // The scenario's; without colour where this machine cannot draw.
  const HardwareCameras& cameras() const { return cameras_; }
  const std::string& renderer() const { return renderer_; }  // empty without colour
  // What the user should know, one sentence each.
  std::vector<std::string> Notes() const;

  // Calls use(truth, world) while the world stands still. Throws what broke the world.
  template <class Use>
  auto WithTruth(const Use& use) {
    if (const std::exception_ptr failure = robot_->failure()) std::rethrow_exception(failure);
    return robot_->With([&](Twin& twin) { return use(*truth_, std::as_const(twin).world()); });
  }

 private:
  SocketFolder sockets_;
  std::string car_;
  HardwareCameras cameras_;
  std::optional<Truth> truth_;  // before the robot, whose thread watches it until its end
  std::unique_ptr<EmulatedRobot> robot_;
  std::string renderer_;
  std::vector<std::string> notes_;
};

}  // namespace merlin
