#include "robot/emulated/microcontroller_emulator.h"

#include <algorithm>
#include <utility>

namespace merlin {

namespace micro = microcontroller;

MicrocontrollerEmulator::MicrocontrollerEmulator(const MicrocontrollerEmulatorConfig& config, EmulatedCar car,
                                                 Time start)
    : config_(config), car_(std::move(car)), start_(start), next_state_(start), heard_(start) {}

void MicrocontrollerEmulator::Receive(Time now, BytesView bytes) {
  for (const auto& received : decoder_.Feed(bytes))
    std::visit([&](const auto& message) { Take(message, received.sequence, now); }, received.message);
}

// A new host, or the old one after a restart: its clock has changed.
void MicrocontrollerEmulator::Take(const micro::Hello&, std::uint8_t, Time) {
  delay_.Reset();
  asked_ = true;
}

void MicrocontrollerEmulator::Take(const micro::Command& command, std::uint8_t sequence, Time now) {
  if (delay_.IsOld(command.host_time_ms)) return;  // a newer one has been received
  const Duration left = command.valid_for - delay_.Lateness(command.host_time_ms, now);
  heard_ = now;
  watchdog_ = false;
  last_command_ = sequence;
  if (left > Duration(0))
    car_.send({.speed_m_s = command.speed_m_s, .steering_rad = command.steering_rad, .valid_for = left});
  else
    car_.send({});
}

void MicrocontrollerEmulator::Take(const micro::PanCommand& command, std::uint8_t, Time) {
  if (car_.pan) car_.pan(command.angle_rad);
}

Bytes MicrocontrollerEmulator::Send(Time now) {
  if (!watchdog_ && now - heard_ > micro::kWatchdog) {
    watchdog_ = true;
    car_.send({});
  }
  Bytes out;
  const auto add = [&](const micro::ToHost& message) {
    const Bytes bytes = micro::Encode(message, sequence_++);
    out.insert(out.end(), bytes.begin(), bytes.end());
  };
  if (std::exchange(asked_, false)) add(micro::HelloReply{.firmware = config_.firmware});
  if (now >= next_state_) {
    add(State(now));
    // On the grid of its rate, unless Send has not been called for long.
    next_state_ = std::max(next_state_ + FromSeconds(1.0 / config_.state_rate_hz), now);
  }
  return out;
}

micro::State MicrocontrollerEmulator::State(Time now) const {
  const DriveState car = car_.read();
  micro::State state;
  state.micro_time_ms = static_cast<std::uint32_t>((now - start_) / std::chrono::milliseconds(1));
  state.encoder_counts = static_cast<std::int32_t>(static_cast<std::uint32_t>(car.encoder_counts));
  state.steering_rad = car.steering_rad;
  state.current_a = car.current_a;
  state.battery_v = car.battery_v;
  state.expired = car.expired;
  state.low_battery = car.battery_v < config_.battery_low_v;
  state.watchdog = watchdog_;
  state.last_command = last_command_;
  if (car_.pan_angle_rad) state.pan_angle_rad = car_.pan_angle_rad();
  return state;
}

}  // namespace merlin
