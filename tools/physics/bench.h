// Measures how fast the physics alone is: one car in a furnished room, no sensors.
#pragma once

#include <atomic>
#include <string>

namespace merlin {

struct PhysicsBench {
  int runs = 7, steps = 10000;   // of each run
  double steps_per_s = 0.0;      // median of the runs
  double times_real_time = 0.0;  // simulated time over wall time
  double least_times_real_time = 80.0;
};

// Returns early, with what it has, when interrupted becomes true.
PhysicsBench BenchPhysics(const std::atomic<bool>& interrupted);

std::string Table(const PhysicsBench& bench);
std::string ToJson(const PhysicsBench& bench);

}  // namespace merlin
