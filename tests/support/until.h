// Helpers for tests of threads: wait for a condition instead of a time. The deadline only ends a test that has failed.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "robot/hal/clock.h"

namespace merlin {

template <class Condition>
bool Until(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

// A clock that stands still until the test moves it.
class HandClock final : public Clock {
 public:
  Time Now() const override { return Time(now_.load()); }
  bool WaitUntil(Time time) override {
    now_ = time.count();
    return true;
  }

 private:
  std::atomic<Time::rep> now_{std::chrono::nanoseconds(std::chrono::seconds(10)).count()};
};

}  // namespace merlin
