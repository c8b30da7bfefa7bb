// Finds out which GL back ends work on this machine.
#pragma once

#include <string>
#include <vector>

namespace merlin::cli {

struct GlProbe {
  std::string backend;  // as --gl takes it: "egl", "osmesa"
  bool works = false;
  std::string detail;  // the renderer's name, or why it does not open
};

// Opens each back end and draws a picture with it. Each gets its own child process, because MuJoCo binds GL once per process
// and because a driver may crash or hang (limit: 20 s). Must be called while the program has one thread. Without the twin
// the result is empty.
std::vector<GlProbe> ProbeGl();

}  // namespace merlin::cli
