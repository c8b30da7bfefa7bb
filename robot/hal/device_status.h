// How a device is.
#pragma once

#include <cstdint>

#include "robot/types/time.h"

namespace merlin {

struct DeviceStatus {
  enum class Health { kOk, kSilent, kFaulty, kAbsent };
  Health health = Health::kOk;
  Time since{0};                // when this health began
  std::uint64_t delivered = 0;  // measurements handed out by Poll
  std::uint64_t missed = 0;     // measurements a newer one replaced before Poll came
  std::uint64_t garbage = 0;    // bytes or frames thrown away as unreadable
};

}  // namespace merlin
