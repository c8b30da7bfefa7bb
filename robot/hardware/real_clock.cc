#include "robot/hardware/real_clock.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace merlin {
namespace {

using Steady = std::chrono::steady_clock;

constexpr Time kForever = std::chrono::hours(24 * 365 * 100);  // far from an overflow

}  // namespace

struct RealClock::Impl {
  Impl(const RealClockConfig& config, Time the_end)
      : watchdog(FromSeconds(config.watchdog_s)), end(std::min(the_end, kForever)) {}

  Time Now() const { return std::chrono::duration_cast<Time>(Steady::now() - start); }

  void Watch() {
    std::unique_lock lock(mutex);
    while (!quit) {
      wake.wait_for(lock, watchdog / 4, [this] { return quit; });
      const bool stalled = working_since && Now() - *working_since > watchdog;
      if (!stalled || std::exchange(told, true)) continue;
      lock.unlock();
      {
        const std::lock_guard stopping(stop_mutex);
        if (stop) stop();
      }
      lock.lock();
    }
  }

  const Steady::time_point start = Steady::now();
  const Duration watchdog;
  Time end;  // used by the stack's thread only
  std::mutex mutex;
  std::condition_variable wake;
  std::optional<Time> working_since;  // when the stack's present tick began; none while it waits in WaitUntil
  bool told = false;
  bool ended = false;
  bool quit = false;
  std::mutex stop_mutex;  // a mutex of its own, because the function may end the run
  std::function<void()> stop;
  std::thread thread;
};

RealClock::RealClock(const RealClockConfig& config, Time end) : impl_(std::make_unique<Impl>(config, end)) {
  impl_->thread = std::thread([this] { impl_->Watch(); });
}

RealClock::~RealClock() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->quit = true;
  }
  impl_->wake.notify_all();
  impl_->thread.join();
}

Time RealClock::Now() const { return impl_->Now(); }

bool RealClock::WaitUntil(Time time) {
  std::unique_lock lock(impl_->mutex);
  impl_->working_since.reset();
  impl_->wake.wait_until(lock, impl_->start + std::min(time, impl_->end), [this] { return impl_->ended; });
  impl_->working_since = Now();
  impl_->told = false;
  return !impl_->ended && time < impl_->end && Now() < impl_->end;
}

void RealClock::EndAt(Time end) { impl_->end = std::min(end, kForever); }

void RealClock::End() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->ended = true;
  }
  impl_->wake.notify_all();
}

void RealClock::OnStall(std::function<void()> stop) {
  const std::lock_guard lock(impl_->stop_mutex);
  impl_->stop = std::move(stop);
}

}  // namespace merlin
