// What every device's Poll promises: measurements in order of stamps, each handed out once. For a slow reader the
// newest few are kept, and what it missed is counted.
//
//            Put                                  Take
//   driver   Put(measurement)                     Take()      all that has come
//   twin     Put(measurement, ready, now)         Take(now)   what is ready by now: its latency is over
//
// It has no lock. An owner that shares it between threads must lock it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "robot/types/device_status.h"
#include "robot/types/time.h"

namespace merlin {

template <class Measurement>
class MeasurementQueue {
 public:
  // places: the number of ready measurements that are kept.
  explicit MeasurementQueue(std::size_t places = 16) : places_(places) {}

  // Puts come in order of stamps, and ready in order, too.
  void Put(Measurement measurement, Time ready, Time now) {
    waiting_.push_back({ready, std::move(measurement)});
    // A measurement that is not ready yet takes no place: a reader misses only what it could have taken.
    while (waiting_.size() > places_ && waiting_[places_].ready <= now) {
      waiting_.pop_front();
      ++missed_;
    }
  }
  void Put(Measurement measurement) { Put(std::move(measurement), Time::min(), Time::min()); }

  std::optional<Measurement> Take(Time now = Time::max()) {
    if (waiting_.empty() || waiting_.front().ready > now) return std::nullopt;
    std::optional<Measurement> oldest = std::move(waiting_.front().measurement);
    waiting_.pop_front();
    ++delivered_;
    return oldest;
  }

  // The status with this queue's counts.
  DeviceStatus Counted(DeviceStatus status) const {
    status.delivered = delivered_;
    status.missed = missed_;
    return status;
  }

 private:
  struct Waiting {
    Time ready;
    Measurement measurement;
  };
  std::size_t places_;
  std::deque<Waiting> waiting_;
  std::uint64_t delivered_ = 0, missed_ = 0;
};

}  // namespace merlin
