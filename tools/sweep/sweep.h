// Runs a sweep: every run is a child process of this program, in a folder of its own below the sweep's. A run that is there
// already, of the same program, models, scenario and seed, is taken over.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/sweep/sweep_file.h"
#include "tools/sweep/table.h"

namespace merlin {

struct SweepOptions {
  std::string name;           // for people
  std::filesystem::path out;  // new, empty, or left by a sweep
  int jobs = 0;               // runs at a time; 0: as many as there are cores
};

struct SweepProgress {
  std::size_t done = 0, of = 0, failed = 0, taken_over = 0;
  std::string last;  // the run that ended last: "S3 seed 2: pass, ATE 0.031 m"
};

struct SweepReport {
  SweepTable table;  // of all runs; empty where it was interrupted
  std::size_t taken_over = 0;
  bool interrupted = false;
  int worst_exit = 0;  // of a run that left no result: 2, 3 or 4; 0: each left one
};

// Leaves table.md, table.csv, runs.csv and table.png in the folder, and of every run its folder and its log. Throws
// InputError for a folder that is somebody else's or in use by another sweep.
SweepReport RunSweep(const Sweep& sweep, const SweepOptions& options, const std::atomic<bool>& stop,
                     const std::function<void(const SweepProgress&)>& progress);

}  // namespace merlin
