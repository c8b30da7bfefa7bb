// What the subcommands that drive a robot take from their command lines alike.
#pragma once

#include <string>

#include "scenarios/run/run.h"

namespace merlin::cli {

// auto, egl, osmesa or off.
Gl GlOf(const std::string& name);

// Of --robot: twin, emulated or hardware:FILE. Fills in the options that say which, and returns what makes its plug.
// Throws InputError for anything else, and for a robot that this program was built without.
PlugMaker PlugOf(const std::string& robot, RunOptions& options);

// 0 also where nothing was judged.
int ExitCodeOf(Verdict verdict);

}  // namespace merlin::cli
