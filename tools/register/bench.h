// How long registration takes beside small_gicp, the fastest that we know: the same clouds, voxels and guesses, one
// thread each, in one run.
#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace merlin {

struct RegisterBench {
  // Median over the rounds of the processor time from the points to the pose: downsampling, normals or covariances, k-d
  // tree and alignment. The error is that of the pose.
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
  std::string skipped{};  // what was not there, or empty
};

// Throws MachineError where small_gicp is absent. Ends early, and unfinished, when interrupted becomes true.
RegisterBench BenchRegister(const std::atomic<bool>& interrupted);

std::string Table(const RegisterBench& bench);
std::string ToJson(const RegisterBench& bench);

}  // namespace merlin
