#include "robot/hardware/drive/microcontroller_host.h"

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

using microcontroller::HelloReply;
using microcontroller::State;

constexpr Duration kGreetPeriod = std::chrono::milliseconds(500);
constexpr std::size_t kCommand_bytes = 20, kState_bytes = 26;  // on the wire
// A state whose time is earlier than the last one's by more than this comes from a microcontroller that has restarted.
// If it is earlier by less, it is an old state that arrived late.
constexpr std::int32_t kRestart_ms = 1000;

}  // namespace

MicrocontrollerHost::MicrocontrollerHost(const MicrocontrollerConfig& config)
    : config_(config), health_(FromSeconds(config.silent_after_s)) {}

void MicrocontrollerHost::Command(const DriveCommand& command, Time now) {
  const bool finite = std::isfinite(command.speed_m_s) && std::isfinite(command.steering_rad);
  command_ = finite ? command : DriveCommand{};
  expires_ = command_->valid_for > Time::max() - now ? Time::max() : now + std::max(command_->valid_for, Duration(0));
  is_new_ = true;
}

void MicrocontrollerHost::Pan(double angle_rad) {
  if (std::isfinite(angle_rad)) pan_rad_ = angle_rad;
}

void MicrocontrollerHost::Connected(Time now) {
  health_.Connected(now);
  greeted_ = false;
  greet_ = now;
  sent_ = now - FromSeconds(1.0);
}

void MicrocontrollerHost::Receive(Time now, BytesView bytes) {
  for (const auto& [sequence, message] : decoder_.Feed(bytes)) {
    health_.Heard(now);
    std::visit([&](const auto& m) { Take(m, now); }, message);
  }
  health_.GarbageSoFar(now, decoder_.counters().garbage_bytes);
  health_.Judge(now);
}

void MicrocontrollerHost::Take(const HelloReply& reply, Time) {
  greeted_ = true;
  firmware_ = reply.firmware;
}

void MicrocontrollerHost::Take(const State& state, Time now) {
  if (last_) {
    const auto step_ms = static_cast<std::int32_t>(state.micro_time_ms - last_->micro_time_ms);
    if (step_ms <= 0 && step_ms > -kRestart_ms) return;  // a duplicate, or an old state
    const bool restarted = step_ms <= -kRestart_ms;
    if (restarted) delay_.Reset();
    // The count continues where the wire's counter wraps. After a restart, when that counter begins again, it stays as
    // it was.
    if (!restarted)
      counts_ += static_cast<std::int32_t>(static_cast<std::uint32_t>(state.encoder_counts) -
                                           static_cast<std::uint32_t>(last_->encoder_counts));
  } else {
    counts_ = state.encoder_counts;
  }
  last_ = state;
  last_stamp_ = std::max(Stamp(state.micro_time_ms, now), last_stamp_ + Duration(1));
  states.Put({.stamp = last_stamp_,
              .encoder_counts = counts_,
              .steering_rad = state.steering_rad,
              .current_a = state.current_a,
              .battery_v = state.battery_v,
              .expired = state.expired});
  has_pan_ = state.pan_angle_rad.has_value();
  if (has_pan_) pan_states.Put({.stamp = last_stamp_, .angle_rad = *state.pan_angle_rad});
}

// The sampling instant. The microcontroller's clock shows by how much this state was later than the quickest one. The
// quickest one took its time on the wire and the documented latency.
Time MicrocontrollerHost::Stamp(std::uint32_t micro_time_ms, Time now) {
  return now - delay_.Lateness(micro_time_ms, now) - WireTime(kState_bytes, config_.serial.baud) -
         FromSeconds(config_.sampling_latency_s);
}

Bytes MicrocontrollerHost::Encoded(const microcontroller::ToMicro& message) {
  return microcontroller::Encode(message, sequence_++);
}

Bytes MicrocontrollerHost::Send(Time now) {
  Bytes out;
  const auto add = [&](const Bytes& bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); };
  if (!greeted_ && now >= greet_) {
    greet_ = now + kGreetPeriod;
    add(Encoded(microcontroller::Hello{}));
  }
  if (pan_rad_) add(Encoded(microcontroller::PanCommand{*std::exchange(pan_rad_, std::nullopt)}));
  if (command_ && now >= next()) {
    const auto now_ms = static_cast<std::uint32_t>(now / std::chrono::milliseconds(1));
    add(Encoded(microcontroller::Command{now_ms, command_->speed_m_s, command_->steering_rad, expires_ - now}));
    sent_ = now;
    is_new_ = false;
  }
  return out;
}

// A new command is sent at once, but not faster than the line can carry commands: they would queue up and arrive late.
Time MicrocontrollerHost::next() const {
  const Duration line_free = WireTime(2 * kCommand_bytes, config_.serial.baud);
  const Time command = sent_ + (is_new_ ? line_free : FromSeconds(1.0 / config_.command_rate_hz));
  if (!command_) return greeted_ ? Time::max() : greet_;
  return greeted_ ? command : std::min(command, greet_);
}

std::string MicrocontrollerHost::Complaint() const {
  using Health = DeviceStatus::Health;
  const std::string where = "microcontroller on " + config_.serial.port + ": ";
  if (status().health == Health::kAbsent) return where + "the port has gone";
  if (decoder_.counters().other_version > 0)
    return where + "it speaks version " + std::to_string(decoder_.other_version()) + " of the protocol; expected " +
           std::to_string(kProtocolVersion);
  if (status().health == Health::kFaulty)
    return where + "nothing it sends can be read; is it set to " + std::to_string(config_.serial.baud) + " baud?";
  if (status().health == Health::kSilent) return where + "it is silent";
  return "";
}

}  // namespace merlin
