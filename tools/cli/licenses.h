// The libraries that the program uses, with their versions and licences, for `merlin doctor`.
#pragma once

#include <string>
#include <vector>

namespace merlin::cli {

struct LinkedWork {
  std::string name;
  std::string version;  // of the copy in use; empty if it does not say
  std::string license;  // SPDX expression, as stated by the work itself or its Debian copyright file
  std::string how;      // how it comes into the program
};

// Everything that is linked, compiled in or loaded at run time. If the twin is built in, its libraries come first.
std::vector<LinkedWork> LinkedWorks();

}  // namespace merlin::cli
