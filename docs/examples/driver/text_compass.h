// A compass that sends a line of text ten times a second over a serial port: "$ATT,<heading>,<roll>,<pitch>\n", in
// degrees; heading clockwise from north, roll to the right, pitch up.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "robot/hal/clock.h"
#include "robot/hal/compass.h"
#include "robot/hal/measurement_queue.h"
#include "robot/hardware/device_health.h"
#include "robot/hardware/serial/serial_thread.h"

namespace merlin {

struct TextCompassConfig {
  SerialConfig serial{.port = "/dev/ttyUSB0", .baud = 9600};
  double north_yaw_rad = 0.0;   // yaw of magnetic north in the map's frame, [-pi, pi]; of the room
  double silent_after_s = 0.5;  // without a good line, [0.2, 10] (guess)
};

template <class Visitor>
void Visit(Visitor& v, TextCompassConfig& c) {
  v("serial", c.serial);
  v("north_yaw_rad", c.north_yaw_rad, Range{-3.1416, 3.1416});
  v("silent_after_s", c.silent_after_s, Range{0.2, 10.0});
}

// The protocol, without port and thread: bytes and times in, readings out.
class TextCompassEnd : public HostEnd {
 public:
  explicit TextCompassEnd(const TextCompassConfig& config);

  MeasurementQueue<CompassReading> readings;
  DeviceStatus status() const { return readings.Counted(health_.status()); }

  void Connected(Time now) override { health_.Connected(now); }
  void Disconnected(Time now) override { health_.Disconnected(now); }
  void Receive(Time now, BytesView bytes) override;
  Bytes Send(Time) override { return {}; }            // it talks without being asked
  Time next() const override { return Time::max(); }  // so there is nothing to send at any time

 private:
  void TakeLine(Time now);

  TextCompassConfig config_;
  DeviceHealth health_;
  std::string line_;
  std::uint64_t garbage_ = 0;
};

// The device as the stack knows it: a port, a thread and the protocol together.
class TextCompass final : public Compass {
 public:
  // Throws MachineError if the port cannot be opened. The clock outlives this.
  TextCompass(const TextCompassConfig& config, const Clock& clock)
      : end_(config), thread_(config.serial, clock, end_, mutex_) {}

  std::optional<CompassReading> Poll() override {
    const std::lock_guard lock(mutex_);
    return end_.readings.Take();
  }
  DeviceStatus Status() const override {
    const std::lock_guard lock(mutex_);
    return end_.status();
  }

 private:
  mutable std::mutex mutex_;
  TextCompassEnd end_;
  SerialThread thread_;  // last: it uses the others
};

}  // namespace merlin
