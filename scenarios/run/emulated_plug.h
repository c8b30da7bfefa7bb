// The twin's emulated devices and the real drivers that use them, in one process. Runs in real time; the truth is
// known.
#pragma once

#include <memory>

#include "scenarios/run/run.h"

namespace merlin {

std::unique_ptr<Plug> MakeEmulatedPlug(const RunOptions& options);

}  // namespace merlin
