// The twin behind the real protocols. Its microcontroller and 3DM are connected by pseudo-terminals, its ToF camera by
// a socket that the stand-in for the maker's library opens, and its colour camera is a network stream on this machine.
// Drivers cannot tell it from a car. The world follows a real clock, so two runs behave alike but do not have the same
// bits.
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

  // sockets: a folder for the ToF camera's socket. The world starts with Start and follows clock, which must outlive
  // this object and be callable from any thread. Throws what Twin throws, and MachineError if a port or socket cannot
  // be opened.
  EmulatedRobot(const TwinOptions& options, const std::filesystem::path& sockets, const Clock& clock);
  ~EmulatedRobot();
  EmulatedRobot(const EmulatedRobot&) = delete;
  EmulatedRobot& operator=(const EmulatedRobot&) = delete;

  void Start();
  // Stops the world for good.
  void Stop();

  std::string drive_port() const { return drive_terminal_.path(); }
  std::optional<std::string> compass_port() const;
  const std::string& depth_socket() const { return depth_socket_; }
  std::optional<std::string> color_url() const;

  // Whether a program has the ToF camera open: every program that drives does, and the system closes it even for one that
  // is killed.
  bool HasDriver() const { return depth_.clients() > 0; }
  // Called after a program has ended: lets the next one open the serial ports.
  void FreePorts();

  // Calls use(twin) while the world stands still.
  template <class Use>
  auto With(const Use& use) {
    const std::lock_guard lock(mutex_);
    return use(twin_);
  }
  // What a step of the world threw, if anything. The world stops then.
  std::exception_ptr failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
  }
  // The longest time that the world has been behind the clock, because this machine was too slow.
  Duration lag() const { return Duration(lag_.load()); }

 private:
  void Run();
  void StepTo(Time now);
  void ServeDevices();
  CompassReading Attitude();

  const Clock& clock_;
  mutable std::mutex mutex_;  // guards the twin and all that reads from it
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
  bool caught_up_ = false;  // used by the thread only
  std::atomic<std::int64_t> lag_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace merlin
