// The judge's first half: the figures of a run, from what the stack found out and what was true.
#pragma once

#include "robot/base/first_fault.h"
#include "robot/types/ground_truth.h"
#include "scenarios/judge/map_size.h"
#include "scenarios/judge/metrics.h"
#include "scenarios/judge/stack_outcome.h"

namespace merlin {

struct Measured {
  Metrics metrics{};
  Pose T_world_map = Pose::Identity();  // aligns the estimated path with the true one
  MapSize size{};
};

// All figures but those of devices, time and memory, which the runner knows. truth null: not known; then the distance
// is the odometry's, and the figures that need the truth stay empty. A figure that cannot be had is left out, and the
// fault kept.
Measured Measure(const StackOutcome& outcome, const GroundTruth* truth, FirstFault& faults);

}  // namespace merlin
