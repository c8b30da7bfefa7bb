// The thread of a driver behind a serial port. It carries bytes between the port and the host's end of the protocol,
// and reopens the port when it is lost.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "robot/hal/clock.h"
#include "robot/hardware/serial/serial_port.h"
#include "robot/protocol/serial_end.h"

namespace merlin {

class HostEnd : public SerialEnd {
 public:
  virtual void Connected(Time now) = 0;
  virtual void Disconnected(Time now) = 0;
};

class SerialThread {
 public:
  // Opens the port, and throws MachineError if it cannot. end is called with mutex held only, and never while waiting
  // for the port. clock, end and mutex must outlive this object.
  SerialThread(const SerialConfig& config, const Clock& clock, HostEnd& end, std::mutex& mutex);
  // Sends what end still has to send.
  ~SerialThread();

  // Call when end has something to send before its next().
  void Wake() { port_.Wake(); }

 private:
  void Run();
  void Step();
  Time Next();
  bool Reopen(Time now);

  const Clock& clock_;
  HostEnd& end_;
  std::mutex& mutex_;
  SerialPort port_;
  Time reopen_{0};
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace merlin
