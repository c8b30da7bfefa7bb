// Where a driver's thread leaves measurements and the stack takes them; neither waits for the other. Knows the status.
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "robot/types/device_status.h"
#include "robot/types/time.h"

namespace merlin {

template <class Measurement>
class Mailbox {
 public:
  // Of what waits it keeps the newest `places`. Silent: ok until nothing has come for so long.
  Mailbox(std::size_t places, Duration silent_after, Time now)
      : places_(places), silent_after_(silent_after), heard_(now) {
    status_.since = now;
  }

  void Put(Measurement measurement, Time now) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(measurement));
    if (waiting_.size() > places_) waiting_.pop_front(), ++status_.missed;
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
    if (waiting_.empty()) return std::nullopt;
    std::optional<Measurement> oldest = std::move(waiting_.front());
    waiting_.pop_front();
    ++status_.delivered;
    return oldest;
  }
  DeviceStatus Status(Time now) const {
    const std::lock_guard lock(mutex_);
    DeviceStatus status = status_;
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
  std::size_t places_;
  Duration silent_after_;
  Time heard_;
  std::deque<Measurement> waiting_;
  DeviceStatus status_;
};

}  // namespace merlin
