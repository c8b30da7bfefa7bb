// `merlin doctor`: what works on this machine, and what the program is made of.
#pragma once

namespace merlin::cli {

// Prints to stdout. licenses: everything linked and its terms instead of the state of the machine; json: for machines.
// Returns the exit code: 0, or 3 when something that a run may need does not work here.
int Doctor(bool licenses, bool json);

}  // namespace merlin::cli
