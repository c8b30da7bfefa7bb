// The PC's end of the line to the 3DM, without a port or a thread. It polls, and turns headings into yaw. Protocol:
// robot/protocol/compass_3dm.h.
#pragma once

#include <string>

#include "robot/hal/measurement_queue.h"
#include "robot/hardware/device_health.h"
#include "robot/hardware/serial/serial_thread.h"
#include "robot/protocol/compass_3dm.h"
#include "robot/types/measurements.h"

namespace merlin {

struct Compass3dmConfig {
  SerialConfig serial{.port = "/dev/ttyUSB0", .baud = 9600};
  compass_3dm::PollerConfig poll{};
  double north_yaw_rad = 0.0;       // yaw of magnetic north in the map's frame, [-pi, pi]; of the room
  bool thesis_arithmetic = false;   // decode angles as MERLIN's own software did, up to 1 deg off
  double sampling_latency_s = 0.0;  // from the last bit of the question to sampling, [0, 0.035] (guess)
  double silent_after_s = 0.5;      // without a good reading, [0.2, 10] (guess)
};

template <class Visitor>
void Visit(Visitor& v, Compass3dmConfig& c) {
  v("serial", c.serial);
  v("poll", c.poll);
  v("north_yaw_rad", c.north_yaw_rad, Range{-3.1416, 3.1416});
  v("thesis_arithmetic", c.thesis_arithmetic);
  v("sampling_latency_s", c.sampling_latency_s, Range{0.0, 0.035});
  v("silent_after_s", c.silent_after_s, Range{0.2, 10.0});
}

class Compass3dmHost : public HostEnd {
 public:
  explicit Compass3dmHost(const Compass3dmConfig& config);

  MeasurementQueue<CompassReading> readings;
  const DeviceStatus& status() const { return health_.status(); }
  double rate_hz() const { return 1.0 / config_.poll.period_s; }  // of readings
  // What is wrong, for people; empty if nothing is.
  std::string Complaint() const;

  void Connected(Time now) override;
  void Disconnected(Time now) override { health_.Disconnected(now); }
  void Receive(Time now, BytesView bytes) override;
  Bytes Send(Time now) override;
  Time next() const override { return poller_.next(); }

 private:
  Compass3dmConfig config_;
  DeviceHealth health_;
  compass_3dm::Poller poller_;
};

}  // namespace merlin
