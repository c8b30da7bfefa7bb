// A serial cable between a device and the program's port, which a test can unplug. The port then disappears, and the
// device receives nothing more.
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "robot/emulated/pseudo_terminal.h"
#include "robot/hardware/serial/serial_port.h"

namespace merlin {

class Cable {
 public:
  // link: the name of the program's port, which stays the same each time it is plugged in.
  Cable(const std::string& device_port, int baud, const std::filesystem::path& link)
      : device_({.port = device_port, .baud = baud}), program_(link) {
    device_.Open();
    thread_ = std::thread([this] { Run(); });
  }
  ~Cable() {
    stop_ = true;
    thread_.join();
  }
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;

  std::filesystem::path port() const { return program_.path(); }
  void Pull() {
    const std::lock_guard lock(mutex_);
    program_.Close();
  }
  void PlugIn() {
    const std::lock_guard lock(mutex_);
    program_.Open();
  }

 private:
  void Run() {
    while (!stop_) {
      {
        const std::lock_guard lock(mutex_);
        device_.Write(program_.Read());
        program_.Write(device_.Read());
      }
      device_.Wait(std::chrono::milliseconds(1));
    }
  }

  SerialPort device_;
  PseudoTerminal program_;
  std::mutex mutex_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace merlin
