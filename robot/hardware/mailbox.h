// Hands measurements from a driver's thread to the stack. Neither waits for the other. It also keeps the device's
// health.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

#include "robot/hal/measurement_queue.h"

namespace merlin {

template <class Measurement>
class Mailbox {
 public:
  // Keeps the newest `places` measurements. The device counts as silent when nothing has come for silent_after.
  Mailbox(std::size_t places, Duration silent_after, Time now)
      : waiting_(places), silent_after_(silent_after), heard_(now) {
    status_.since = now;
  }

  void Put(Measurement measurement, Time now) {
    const std::lock_guard lock(mutex_);
    waiting_.Put(std::move(measurement));
    Change(DeviceStatus::Health::kOk, now);
    heard_ = now;
  }
  void Become(DeviceStatus::Health health, Time now) {
    const std::lock_guard lock(mutex_);
    Change(health, now);
    heard_ = now;
  }
  void CountGarbage() {
    const std::lock_guard lock(mutex_);
    ++status_.garbage;
  }
  std::optional<Measurement> Take() {
    const std::lock_guard lock(mutex_);
    return waiting_.Take();
  }
  DeviceStatus Status(Time now) const {
    const std::lock_guard lock(mutex_);
    DeviceStatus status = waiting_.Counted(status_);
    if (status.health == DeviceStatus::Health::kOk && now - heard_ > silent_after_)
      status.health = DeviceStatus::Health::kSilent, status.since = heard_ + silent_after_;
    return status;
  }

 private:
  void Change(DeviceStatus::Health health, Time now) {
    const bool was_silent = status_.health == DeviceStatus::Health::kOk && now - heard_ > silent_after_;
    if (status_.health == health && !was_silent) return;
    status_.health = health;
    status_.since = now;
  }

  mutable std::mutex mutex_;
  MeasurementQueue<Measurement> waiting_;
  Duration silent_after_;
  Time heard_;
  DeviceStatus status_;
};

}  // namespace merlin
