// Measurements on their way: in order of stamps, each handed out once, when its latency is over.
#pragma once

#include <cstddef>
#include <deque>
#include <future>
#include <optional>
#include <utility>

#include "robot/types/device_status.h"
#include "robot/types/time.h"

namespace merlin {

template <class Measurement>
class Outbox {
 public:
  explicit Outbox(Duration latency) : latency_(latency) {}

  // out: when it may be taken, where that is not its stamp plus the latency.
  void Put(Time stamp, Time out, std::future<Measurement> measurement) {
    waiting_.push_back({out, std::move(measurement)});
    // Of those that could have been taken a slow reader keeps the newest few; what is on its way is not his fault.
    while (waiting_.size() > kCapacity && waiting_[kCapacity].out <= stamp) {
      waiting_.pop_front();
      ++status_.missed;
    }
  }
  void Put(Time stamp, std::future<Measurement> measurement) { Put(stamp, stamp + latency_, std::move(measurement)); }
  void Put(Time stamp, Measurement measurement) {
    std::promise<Measurement> promise;
    promise.set_value(std::move(measurement));
    Put(stamp, promise.get_future());
  }
  std::optional<Measurement> Take(Time now) {
    if (waiting_.empty() || waiting_.front().out > now) return std::nullopt;
    Measurement measurement = waiting_.front().measurement.get();
    waiting_.pop_front();
    ++status_.delivered;
    return measurement;
  }
  const DeviceStatus& status() const { return status_; }

 private:
  static constexpr std::size_t kCapacity = 16;
  struct Waiting {
    Time out;
    std::future<Measurement> measurement;
  };
  Duration latency_;
  std::deque<Waiting> waiting_;
  DeviceStatus status_;
};

}  // namespace merlin
