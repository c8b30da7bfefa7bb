// The second half of the judge: writes the files of a run except result.json and junit.xml, which need the verdict.
#pragma once

#include <string>

#include "scenarios/judge/measure.h"
#include "scenarios/judge/output_folder.h"
#include "scenarios/judge/result.h"

namespace merlin {

// Writes trajectories, map, grid and picture. title: of the picture, ASCII. Returns the hashes of the trajectory and
// map files. If a file cannot be written, the exception is added to faults and the other files are still written.
Hashes WriteRun(const std::string& title, const StackOutcome& outcome, const GroundTruth* truth,
                const Measured& measured, const OutputFolder& folder, FirstFault& faults);

}  // namespace merlin
