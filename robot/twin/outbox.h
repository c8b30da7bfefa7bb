// Measurements of the twin on their way to the stack. Each can be taken once its latency is over. If a worker has not
// finished it by then, taking it waits for the worker.
#pragma once

#include <future>
#include <optional>
#include <utility>

#include "robot/hal/measurement_queue.h"

namespace merlin {

template <class Measurement>
class Outbox {
 public:
  explicit Outbox(Duration latency) : latency_(latency) {}

  // Called at its stamp. ready: when it may be taken, if not at its stamp plus the latency.
  void Put(Time stamp, Time ready, std::future<Measurement> measurement) {
    queue_.Put(std::move(measurement), ready, stamp);
  }
  void Put(Time stamp, std::future<Measurement> measurement) { Put(stamp, stamp + latency_, std::move(measurement)); }
  void Put(Time stamp, Measurement measurement) {
    std::promise<Measurement> promise;
    promise.set_value(std::move(measurement));
    Put(stamp, promise.get_future());
  }
  std::optional<Measurement> Take(Time now) {
    std::optional<std::future<Measurement>> oldest = queue_.Take(now);
    if (!oldest) return std::nullopt;
    return oldest->get();
  }
  DeviceStatus status() const { return queue_.Counted({}); }

 private:
  Duration latency_;
  MeasurementQueue<std::future<Measurement>> queue_;
};

}  // namespace merlin
