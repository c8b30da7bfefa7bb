// `merlin doctor`: what works on this machine, and what the program is made of.
#pragma once

namespace merlin::cli {

// Prints the state of the machine to stdout, or with `licenses` everything that is linked and its licence. json: as JSON.
// Returns the exit code that a run would have: 0 all is well; 2 models or scenarios are missing (MERLIN_HOME); 3 this machine
// cannot draw pictures.
int Doctor(bool licenses, bool json);

}  // namespace merlin::cli
