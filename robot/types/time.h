// Time of a run: nanoseconds since the run's start. Integer, so that adding a period a million times does not drift.
#pragma once

#include <chrono>
#include <cmath>

namespace merlin {

using Duration = std::chrono::nanoseconds;
using Time = std::chrono::nanoseconds;  // since the run's start

inline double Seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

// Nearest nanosecond; |seconds| < 9e9.
inline Duration FromSeconds(double seconds) { return Duration(std::llround(seconds * 1e9)); }

}  // namespace merlin
