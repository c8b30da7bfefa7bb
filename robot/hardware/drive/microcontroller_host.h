// The PC's end of the line to the microcontroller, without a port or a thread. It repeats the command in force, and
// turns the microcontroller's states into measurements. Protocol: robot/protocol/microcontroller.h.
#pragma once

#include <string>

#include "robot/hal/measurement_queue.h"
#include "robot/hal/pan_unit.h"
#include "robot/hardware/device_health.h"
#include "robot/hardware/serial/serial_thread.h"
#include "robot/protocol/least_delay.h"
#include "robot/protocol/microcontroller.h"
#include "robot/types/measurements.h"

namespace merlin {

struct MicrocontrollerConfig {
  SerialConfig serial{.port = "/dev/ttyS0", .baud = 57600};  // COM1
  double command_rate_hz =
      20.0;  // at which the command in force is repeated, [10, 100]; the microcontroller's watchdog waits 0.15 s (guess)
  double sampling_latency_s = 0.0;  // from sampling to a state's first bit, [0, 0.1] (guess)
  double silent_after_s = 0.5;      // without a good message, [0.05, 10] (guess)
};

template <class Visitor>
void Visit(Visitor& v, MicrocontrollerConfig& c) {
  v("serial", c.serial);
  v("command_rate_hz", c.command_rate_hz, Range{10.0, 100.0});
  v("sampling_latency_s", c.sampling_latency_s, Range{0.0, 0.1});
  v("silent_after_s", c.silent_after_s, Range{0.05, 10.0});
}

class MicrocontrollerHost : public HostEnd {
 public:
  explicit MicrocontrollerHost(const MicrocontrollerConfig& config);

  // The stack's side; see robot/hal/drive.h. A pan angle that is not finite is ignored.
  void Command(const DriveCommand& command, Time now);
  void Pan(double angle_rad);
  MeasurementQueue<DriveState> states;
  MeasurementQueue<PanState> pan_states;
  const DeviceStatus& status() const { return health_.status(); }
  bool has_pan() const { return has_pan_; }
  const std::string& firmware() const { return firmware_; }  // empty until the microcontroller has reported it
  // What is wrong, for people; empty if nothing is.
  std::string Complaint() const;

  // The line's side.
  void Connected(Time now) override;
  void Disconnected(Time now) override { health_.Disconnected(now); }
  void Receive(Time now, BytesView bytes) override;
  Bytes Send(Time now) override;
  Time next() const override;

 private:
  void Take(const microcontroller::State& state, Time now);
  void Take(const microcontroller::HelloReply& reply, Time now);
  Time Stamp(std::uint32_t micro_time_ms, Time now);
  Bytes Encoded(const microcontroller::ToMicro& message);

  MicrocontrollerConfig config_;
  DeviceHealth health_;
  microcontroller::Decoder<microcontroller::ToHost> decoder_;
  std::uint8_t sequence_ = 0;

  std::optional<DriveCommand> command_;  // in force, or expired
  Time expires_{0};
  bool is_new_ = false;
  Time sent_{0};
  std::optional<double> pan_rad_;
  bool greeted_ = false;
  Time greet_{0};
  std::string firmware_;

  LeastDelay delay_;
  std::optional<microcontroller::State> last_;
  Time last_stamp_{Time::min()};
  std::int64_t counts_ = 0;
  bool has_pan_ = false;
};

}  // namespace merlin
