// What the simulated world and its watcher know, as the data that the judge takes.
#pragma once

#include "robot/types/ground_truth.h"
#include "scenarios/run/truth.h"

namespace merlin {

// range_m looks at the world as it stands now; the world outlives the result.
GroundTruth GroundTruthOf(const Truth& truth, const sim::World& world);

}  // namespace merlin
