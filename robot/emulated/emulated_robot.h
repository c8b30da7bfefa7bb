// The twin behind the real protocols: a running car whose microcontroller and 3DM speak over pseudo-terminals, whose ToF
// camera is found by its maker's library behind a socket, and whose colour camera is a stream on this machine. Drivers
// cannot tell it from a car. Paced by a real clock: its runs repeat in what they do, not in every bit.
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "robot/emulated/compass_3dm_emulator.h"
#include "robot/emulated/depth_server.h"
#include "robot/emulated/microcontroller_emulator.h"
#include "robot/emulated/mjpeg_server.h"
#include "robot/emulated/pseudo_terminal.h"
#include "robot/emulated/serial_pump.h"
#include "robot/hal/clock.h"
#include "robot/twin/twin.h"

namespace merlin {

class EmulatedRobot {
 public:
  static constexpr int kDriveBaud = 57600;
  static constexpr double kStreamLatency_s = 0.006;  // measured: coding, network and decoding of a picture

  // sockets: a folder for the ToF camera's socket. The world begins to run when Start is called, and follows clock, which
  // outlives this and may be asked from any thread. Throws as Twin does, and MachineError where a port or socket cannot
  // be had.
  EmulatedRobot(const TwinOptions& options, const std::filesystem::path& sockets, const Clock& clock);
  ~EmulatedRobot();
  EmulatedRobot(const EmulatedRobot&) = delete;
  EmulatedRobot& operator=(const EmulatedRobot&) = delete;

  void Start();
  // The world stands still from here on.
  void Stop();

  std::string drive_port() const { return drive_terminal_.path(); }
  std::optional<std::string> compass_port() const;
  const std::string& depth_socket() const { return depth_socket_; }
  std::optional<std::string> color_url() const;

  // Whether a program has the ToF camera open: every program that drives does, and the system closes it even for one that
  // is killed.
  bool HasDriver() const { return depth_.clients() > 0; }
  // After a program has gone: the next one may open the serial ports.
  void FreePorts();

  // Calls use(twin) while the world stands still.
  template <class Use>
  auto With(const Use& use) {
    const std::lock_guard lock(mutex_);
    return use(twin_);
  }
  // What stepping the world threw; null: nothing. The world stands still from then on.
  std::exception_ptr failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
  }
  // The farthest the world has fallen behind the clock: this machine was too slow.
  Duration lag() const { return Duration(lag_.load()); }

 private:
  void Run();
  void StepTo(Time now);
  void ServeDevices();
  CompassReading Attitude();

  const Clock& clock_;
  mutable std::mutex mutex_;  // of the twin and what reads it
  Twin twin_;
  Robot robot_;
  std::optional<CompassReading> attitude_;
  PseudoTerminal drive_terminal_;
  MicrocontrollerEmulator drive_;
  SerialPump drive_pump_;
  std::optional<PseudoTerminal> compass_terminal_;
  std::optional<Compass3dmEmulator> compass_;
  std::optional<SerialPump> compass_pump_;
  std::string depth_socket_;
  DepthServer depth_;
  std::optional<MjpegServer> color_;
  std::exception_ptr failure_;
  bool caught_up_ = false;  // the thread's
  std::atomic<std::int64_t> lag_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace merlin
