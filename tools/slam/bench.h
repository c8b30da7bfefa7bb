// Measures how fast the stack finds the pose: the registration alone, a whole frame from filter to pose, and the frames of a
// lap, in which loops are closed.
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace merlin {

struct SlamBench {
  struct Row {
    std::string what;
    int points = 0;  // median
    double median_ms = 0.0, p99_ms = 0.0, max_ms = 0.0;
    double median_limit_ms = 0.0, p99_limit_ms = 0.0, max_limit_ms = 0.0;  // 0: none
  };
  int rounds = 200;            // of each registration
  int frames = 0;              // of the drive
  double not_converged = 0.0;  // share of its frames
  int loops = 0;               // closed on the lap
  std::vector<Row> rows{};
};

// Returns early, with what it has, when interrupted becomes true.
SlamBench BenchSlam(const std::atomic<bool>& interrupted);

std::string Table(const SlamBench& bench);
std::string ToJson(const SlamBench& bench);

}  // namespace merlin
