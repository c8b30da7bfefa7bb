#include "robot/hardware/device_health.h"

namespace merlin {

void DeviceHealth::Connected(Time now) {
  connected_ = true;
  heard_.reset();
  garbled_.reset();
  Judge(now);
}

void DeviceHealth::Disconnected(Time now) {
  connected_ = false;
  Judge(now);
}

void DeviceHealth::Heard(Time now) {
  heard_ = now;
  Judge(now);
}

void DeviceHealth::GarbageSoFar(Time now, std::uint64_t garbage) {
  if (garbage != status_.garbage) garbled_ = now;
  status_.garbage = garbage;
}

void DeviceHealth::Judge(Time now) {
  using Health = DeviceStatus::Health;
  const auto recently = [&](const std::optional<Time>& time) { return time && now - *time <= silent_after_; };
  if (!connected_) return Set(Health::kAbsent, now);
  if (recently(heard_)) return Set(Health::kOk, now);
  Set(recently(garbled_) ? Health::kFaulty : Health::kSilent, now);
}

void DeviceHealth::Set(DeviceStatus::Health health, Time now) {
  if (health == status_.health) return;
  status_.health = health;
  status_.since = now;
}

}  // namespace merlin
