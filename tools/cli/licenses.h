// What the program is made of besides its own sources: for `merlin doctor`.
#pragma once

#include <string>
#include <vector>

namespace merlin::cli {

struct LinkedWork {
  std::string name;
  std::string version;  // of the copy used here, where it tells
  std::string license;  // SPDX expression, as stated by the work itself or its Debian copyright file
  std::string how;      // how it comes into the program
};

// Everything that is linked, compiled in or loaded at run time, the twin's parts first where it is built in.
std::vector<LinkedWork> LinkedWorks();

}  // namespace merlin::cli
