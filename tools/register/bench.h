// Compares the speed of our registration with that of small_gicp, the fastest library that we know. Both get the same clouds,
// voxels and initial guesses, and one thread, in the same run.
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace merlin {

struct RegisterBench {
  // median_ms: processor time from the points to the pose (downsampling, normals or covariances, k-d tree, alignment),
  // median over the rounds. error_*: of the pose.
  struct Figures {
    double median_ms = 0.0;
    double error_mm = 0.0, error_deg = 0.0;
    int iterations = 0;
  };
  struct Row {
    std::string pair;
    double voxel_m = 0.0;
    Figures ours, theirs;
  };
  int rounds = 0;
  std::vector<Row> rows{};
  std::string skipped{};  // which data were missing; empty: none
};

// Throws MachineError if small_gicp is not installed. Returns early, with what it has, when interrupted becomes true.
RegisterBench BenchRegister(const std::atomic<bool>& interrupted);

std::string Table(const RegisterBench& bench);
std::string ToJson(const RegisterBench& bench);

}  // namespace merlin
