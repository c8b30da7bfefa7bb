// The health of a device behind a port, judged by its messages. Without a port it is absent; while good messages come,
// ok; while only unreadable ones come, faulty; else silent, also before the first message.
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
  void GarbageSoFar(Time now, std::uint64_t garbage);     // the total so far
  void Judge(Time now);                                   // call regularly
  const DeviceStatus& status() const { return status_; }  // without delivered and missed, which the queue counts

 private:
  void Set(DeviceStatus::Health health, Time now);

  Duration silent_after_;
  bool connected_ = false;
  std::optional<Time> heard_, garbled_;
  DeviceStatus status_{.health = DeviceStatus::Health::kAbsent};
};

}  // namespace merlin
