#include "robot/hardware/compass/compass_3dm_host.h"

#include <cmath>
#include <numbers>

namespace merlin {
namespace {

double WrapHalfOpen(double angle_rad) {  // (-pi, pi]
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

}  // namespace

Compass3dmHost::Compass3dmHost(const Compass3dmConfig& config)
    : config_(config), health_(FromSeconds(config.silent_after_s)), poller_(config.poll) {}

void Compass3dmHost::Connected(Time now) { health_.Connected(now); }

void Compass3dmHost::Receive(Time now, BytesView bytes) { poller_.Receive(now, bytes); }

Bytes Compass3dmHost::Send(Time now) {
  Bytes out = poller_.Send(now);
  if (const auto reading = poller_.Take()) {
    using compass_3dm::Arithmetic;
    const auto attitude =
        ToAttitude(reading->counts, config_.thesis_arithmetic ? Arithmetic::kThesis : Arithmetic::kExact);
    readings.Put({.stamp = reading->asked + WireTime(1, config_.serial.baud) + FromSeconds(config_.sampling_latency_s),
                  .roll_rad = attitude.roll_rad,
                  .pitch_rad = attitude.pitch_rad,
                  .yaw_rad = WrapHalfOpen(config_.north_yaw_rad - attitude.heading_rad)});
    health_.Heard(now);
  }
  health_.GarbageSoFar(now, poller_.garbage_bytes());
  health_.Judge(now);
  return out;
}

std::string Compass3dmHost::Complaint() const {
  using Health = DeviceStatus::Health;
  const std::string where = "3DM on " + config_.serial.port + ": ";
  switch (status().health) {
    case Health::kAbsent:
      return where + "the port has gone";
    case Health::kSilent:
      return where + "it does not answer";
    case Health::kFaulty:
      return where + "its answers are not readings; is it set to " + std::to_string(config_.serial.baud) + " baud?";
    case Health::kOk:
      break;
  }
  return "";
}

}  // namespace merlin
