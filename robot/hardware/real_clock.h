// Time on the car: the machine's steady clock, counted from the start of the run. A watchdog on its own thread stops
// the car when the stack stops waiting for its next tick.
#pragma once

#include <functional>
#include <memory>

#include "robot/base/config.h"
#include "robot/hal/clock.h"

namespace merlin {

struct RealClockConfig {
  double watchdog_s = 0.5;  // the longest a tick may take, [0.05, 60] (guess)
};

template <class Visitor>
void Visit(Visitor& v, RealClockConfig& c) {
  v("watchdog_s", c.watchdog_s, Range{0.05, 60.0});
}

class RealClock : public Clock {
 public:
  // end: from this time on WaitUntil returns false. The clock starts now.
  RealClock(const RealClockConfig& config, Time end);
  ~RealClock() override;

  // From any thread.
  Time Now() const override;
  bool WaitUntil(Time time) override;
  // From this time on WaitUntil returns false; replaces the end given to the constructor. Call from the stack's thread.
  void EndAt(Time end);
  // Ends the run: WaitUntil returns false at once, also a call that is waiting now. May be called from any thread, but
  // not from a signal handler.
  void End();

  // Sets the function that the watchdog calls, on its own thread, once each time the stack stalls; never before the
  // stack's first tick. OnStall waits for a call of the old function to end, so that what that function uses may be
  // destroyed afterwards.
  void OnStall(std::function<void()> stop);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin
