// The state of a device, as its driver reports it.
#pragma once

#include <cstdint>

#include "robot/types/time.h"

namespace merlin {

struct DeviceStatus {
  // Silent: connected, but it sends nothing. Faulty: what it sends cannot be read. Absent: unplugged, or never
  // connected.
  enum class Health { kOk, kSilent, kFaulty, kAbsent };
  Health health = Health::kOk;
  Time since{0};                // when this health began
  std::uint64_t delivered = 0;  // measurements handed out by Poll
  std::uint64_t missed = 0;     // measurements replaced by newer ones before Poll was called
  std::uint64_t garbage = 0;    // bytes or frames thrown away as unreadable
  double rate_hz = 0.0;         // at which it is set up to measure; 0: not known
};

// The same status, for a device that measures at this rate.
inline DeviceStatus WithRate(DeviceStatus status, double rate_hz) {
  status.rate_hz = rate_hz;
  return status;
}

}  // namespace merlin
