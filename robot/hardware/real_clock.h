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
  // end: from here on WaitUntil returns false. Starts now.
  RealClock(const RealClockConfig& config, Time end);
  ~RealClock() override;

  // From any thread.
  Time Now() const override;
  bool WaitUntil(Time time) override;
  // From that time on WaitUntil returns false, as end of the constructor has it. From the stack's thread.
  void EndAt(Time end);
  // The run is over: WaitUntil returns false at once, also one that waits now. From any thread, not from a signal
  // handler.
  void End();

  // What the watchdog calls, on its thread, once each time the stack stalls; not before the stack's first tick. It
  // returns when a call under way is over, so that what the old function uses may go.
  void OnStall(std::function<void()> stop);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin
