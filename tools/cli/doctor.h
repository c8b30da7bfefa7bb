// `merlin doctor`: what works on this machine, and what the program is made of.
#pragma once

namespace merlin::cli {

// Prints to stdout. licenses: everything linked and its terms instead of the state of the machine; json: for machines.
// Returns the exit code that a run would have: 0; 2 where models or scenarios are missing (MERLIN_HOME); 3 when this
// machine cannot draw.
int Doctor(bool licenses, bool json);

}  // namespace merlin::cli
