// How a device behind a port is, judged by what came when: absent without a port, ok as long as good messages come,
// faulty while only unreadable ones do, else silent (also before the first).
#pragma once

#include <cstdint>
#include <optional>

#include "robot/types/device_status.h"

namespace merlin {

class DeviceHealth {
 public:
  explicit DeviceHealth(Duration silent_after) : silent_after_(silent_after) {}

  void Connected(Time now);
  void Disconnected(Time now);
  void Heard(Time now);                                   // a good message
  void GarbageSoFar(Time now, std::uint64_t garbage);     // the device's count of it
  void Judge(Time now);                                   // call it again and again
  const DeviceStatus& status() const { return status_; }  // delivered and missed are not its affair

 private:
  void Set(DeviceStatus::Health health, Time now);

  Duration silent_after_;
  bool connected_ = false;
  std::optional<Time> heard_, garbled_;
  DeviceStatus status_{.health = DeviceStatus::Health::kAbsent};
};

}  // namespace merlin
