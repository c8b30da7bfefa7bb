// The twin behind its real drivers and protocols, both in this program: in real time, and the truth is known.
#pragma once

#include <memory>

#include "scenarios/run/run.h"

namespace merlin {

std::unique_ptr<Plug> MakeEmulatedPlug(const RunOptions& options);

}  // namespace merlin
