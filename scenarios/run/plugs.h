// The plugs of the program with the twin.
#pragma once

#include <memory>

#include "scenarios/run/run.h"

namespace merlin {

// By options.robot.
std::unique_ptr<Plug> MakePlug(const RunOptions& options);

// RunScenario of run.h with these plugs.
RunReport RunScenario(const RunOptions& options, const std::atomic<bool>& stop);

}  // namespace merlin
