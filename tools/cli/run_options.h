// Options that all subcommands which run a scenario have in common.
#pragma once

#include <string>

#include "scenarios/run/plugs.h"

namespace merlin::cli {

// auto, egl, osmesa or off.
Gl GlOf(const std::string& name);

// twin, emulated or hardware:FILE; throws InputError for anything else.
void SetRobot(const std::string& text, RunOptions& options);

}  // namespace merlin::cli
