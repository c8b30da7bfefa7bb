// Command-line options that all subcommands driving a robot share.
#pragma once

#include <string>

#include "scenarios/run/run.h"

namespace merlin::cli {

// auto, egl, osmesa or off.
Gl GlOf(const std::string& name);

// Parses --robot: twin, emulated or hardware:FILE. Sets the robot in the options and returns the maker of its plug.
// Throws InputError for anything else, and for a robot that this program was built without.
PlugMaker PlugOf(const std::string& robot, RunOptions& options);

// The exit code for a verdict; 0 also if nothing was judged.
int ExitCodeOf(Verdict verdict);

}  // namespace merlin::cli
