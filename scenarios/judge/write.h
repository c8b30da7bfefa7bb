// The judge's second half: the files of a run, but for result.json and junit.xml, which need the verdict.
#pragma once

#include <string>

#include "scenarios/judge/measure.h"
#include "scenarios/judge/output_folder.h"
#include "scenarios/judge/result.h"

namespace merlin {

// Trajectories, map, grid and picture (titled title, ASCII). Returns the hashes of the trajectory and the map as
// written. A file that cannot be written is left out, and the fault kept: the rest comes.
Hashes WriteRun(const std::string& title, const StackOutcome& outcome, const GroundTruth* truth,
                const Measured& measured, const OutputFolder& folder, FirstFault& faults);

}  // namespace merlin
