// Slows a run down to a multiple of real time, and reports its progress a few times a second.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <thread>

#include "scenarios/run/run.h"

namespace merlin {

using WallClock = std::chrono::steady_clock;

inline double SecondsSince(WallClock::time_point begin) {
  return std::chrono::duration<double>(WallClock::now() - begin).count();
}

// Reports progress. An exception of the reader, for example a closed pipe, must not stop the car.
template <class Progress>
void Tell(const Progress& progress) {
  try {
    progress();
  } catch (const std::exception&) {
  }
}

class Pacer {
 public:
  Pacer(const RunOptions& options, const std::atomic<bool>& stop) : options_(options), stop_(stop) {}
  void Tick(const LoopState& state) {
    while (options_.pace > 0.0 && !stop_.load()) {
      const double ahead_s = Seconds(state.now - state.began) / options_.pace - SecondsSince(begin_);
      if (ahead_s <= 0.0) break;
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(ahead_s, 0.05)));  // Ctrl-C must not wait
    }
    if (!options_.progress || SecondsSince(reported_) < 0.2) return;
    reported_ = WallClock::now();
    Tell([&] { options_.progress(state); });
  }

 private:
  const RunOptions& options_;
  const std::atomic<bool>& stop_;
  WallClock::time_point begin_ = WallClock::now(), reported_ = begin_;
};

}  // namespace merlin
