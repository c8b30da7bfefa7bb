// Which of the GL back ends open on this machine.
#pragma once

#include <string>
#include <vector>

namespace merlin::cli {

struct GlProbe {
  std::string backend;  // as --gl takes it: "egl", "osmesa"
  bool works = false;
  std::string detail;  // the renderer's name, or why it does not open
};

// Opens each back end and draws a picture with it, in a child process of its own: MuJoCo binds GL once a process, and a
// driver may crash or hang (20 s are given). Call from a program with one thread. Empty without the twin.
std::vector<GlProbe> ProbeGl();

}  // namespace merlin::cli
