// Turns the truth about the simulated world into the plain data that the judge uses.
#pragma once

#include "robot/types/ground_truth.h"
#include "scenarios/run/truth.h"

namespace merlin {

// range_m of the result casts rays into the world's present state; the world must outlive the result.
GroundTruth GroundTruthOf(const Truth& truth, const sim::World& world);

}  // namespace merlin
