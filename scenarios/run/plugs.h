// All plugs of the build with the twin.
#pragma once

#include <memory>

#include "scenarios/run/run.h"

namespace merlin {

// Makes the plug for options.robot.
std::unique_ptr<Plug> MakePlug(const RunOptions& options);

// RunScenario of run.h with these plugs.
RunReport RunScenario(const RunOptions& options, const std::atomic<bool>& stop);

}  // namespace merlin
