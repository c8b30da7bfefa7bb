// Measurements from a driver's thread to the stack: in order of stamps, each handed out once. A slow reader keeps the
// newest few, as in the twin. Its owner locks.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "robot/types/device_status.h"

namespace merlin {

template <class Measurement>
class MeasurementQueue {
 public:
  void Put(Measurement measurement) {
    waiting_.push_back(std::move(measurement));
    if (waiting_.size() <= kCapacity) return;
    waiting_.pop_front();
    ++missed_;
  }
  std::optional<Measurement> Take() {
    if (waiting_.empty()) return std::nullopt;
    std::optional<Measurement> oldest = std::move(waiting_.front());
    waiting_.pop_front();
    ++delivered_;
    return oldest;
  }
  DeviceStatus Counted(DeviceStatus status) const {
    status.delivered = delivered_;
    status.missed = missed_;
    return status;
  }

 private:
  static constexpr std::size_t kCapacity = 16;
  std::deque<Measurement> waiting_;
  std::uint64_t delivered_ = 0, missed_ = 0;
};

}  // namespace merlin
