// How fast the physics alone is: one car in a furnished room.
#pragma once

#include <atomic>
#include <string>

namespace merlin {

struct PhysicsBench {
  int runs = 7, steps = 10000;   // of each run
  double steps_per_s = 0.0;      // the runs' median
  double times_real_time = 0.0;  // the same times the step
  double least_times_real_time = 80.0;
};

// Ends early, and unfinished, when interrupted becomes true.
PhysicsBench BenchPhysics(const std::atomic<bool>& interrupted);

std::string Table(const PhysicsBench& bench);
std::string ToJson(const PhysicsBench& bench);

}  // namespace merlin
