// The car's microcontroller as a state machine that drives a simulated car. It shows what a real firmware must do with
// the protocol of robot/protocol/microcontroller.h.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "robot/base/config.h"
#include "robot/protocol/least_delay.h"
#include "robot/protocol/microcontroller.h"
#include "robot/protocol/serial_end.h"
#include "robot/types/measurements.h"

namespace merlin {

// What the microcontroller is wired to. For a car without a pan unit, leave its two functions empty.
struct EmulatedCar {
  std::function<void(const DriveCommand&)> send;  // as Drive::Send: the command expires by itself
  std::function<DriveState()> read;               // the state now
  std::function<void(double angle_rad)> pan{};
  std::function<double()> pan_angle_rad{};
};

struct MicrocontrollerEmulatorConfig {
  double state_rate_hz = microcontroller::kStateRate_hz;  // [1, 200]
  double battery_low_v = 10.8;                            // [0, 60]; below it a state says so; 0.9 of 12 V (guess)
  std::string firmware = "merlin emulator 1";
};

template <class Visitor>
void Visit(Visitor& v, MicrocontrollerEmulatorConfig& c) {
  v("state_rate_hz", c.state_rate_hz, Range{1.0, 200.0});
  v("battery_low_v", c.battery_low_v, Range{0.0, 60.0});
  v("firmware", c.firmware);
}

class MicrocontrollerEmulator : public SerialEnd {
 public:
  // start: when it is switched on.
  MicrocontrollerEmulator(const MicrocontrollerEmulatorConfig& config, EmulatedCar car, Time start);

  void Receive(Time now, BytesView bytes) override;
  Bytes Send(Time now) override;  // also runs the watchdog
  Time next() const override { return next_state_; }

  const LinkCounters& counters() const { return decoder_.counters(); }

 private:
  void Take(const microcontroller::Hello&, std::uint8_t sequence, Time now);
  void Take(const microcontroller::Command& command, std::uint8_t sequence, Time now);
  void Take(const microcontroller::PanCommand& command, std::uint8_t sequence, Time now);
  microcontroller::State State(Time now) const;

  MicrocontrollerEmulatorConfig config_;
  EmulatedCar car_;
  Time start_, next_state_, heard_;
  microcontroller::Decoder<microcontroller::ToMicro> decoder_;
  LeastDelay delay_;
  bool watchdog_ = true;  // braked until the first command
  bool asked_ = false;
  std::uint8_t last_command_ = 0;
  std::uint8_t sequence_ = 0;
};

}  // namespace merlin
