// Runs a sweep. Every run is a child process of this program with its own folder inside the sweep's folder. A run that
// exists already, of the same program, models, scenario and seed, is reused.
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
  std::string name;           // for display
  std::filesystem::path out;  // new, empty, or of an earlier sweep
  int jobs = 0;               // runs at a time; 0: the number of cores
};

struct SweepProgress {
  std::size_t done = 0, of = 0, failed = 0, taken_over = 0;
  std::string last;  // the run that ended last: "S3 seed 2: pass, ATE 0.031 m"
};

struct SweepReport {
  SweepTable table;  // of all runs; empty if interrupted
  std::size_t taken_over = 0;
  bool interrupted = false;
  int worst_exit = 0;  // largest exit code (2, 3 or 4) of a run without a result; 0: all runs have one
};

// Writes table.md, table.csv, runs.csv and table.png into the folder, and a folder and a log for every run. Throws
// InputError if the folder holds other files or is in use by another sweep.
SweepReport RunSweep(const Sweep& sweep, const SweepOptions& options, const std::atomic<bool>& stop,
                     const std::function<void(const SweepProgress&)>& progress);

}  // namespace merlin
