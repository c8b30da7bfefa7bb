// The twin: the world waits for the stack, and the same seed gives the same bits.
#pragma once

#include <memory>

#include "scenarios/run/run.h"

namespace merlin {

std::unique_ptr<Plug> MakeTwinPlug(const RunOptions& options);

}  // namespace merlin
