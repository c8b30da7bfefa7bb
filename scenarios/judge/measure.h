// The first half of the judge: computes the metrics of a run from the results of the stack and the ground truth.
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

// Computes all metrics except those of devices, time and memory, which the runner sets. truth: null if not known; then
// the distance is that of the odometry, and metrics that need the truth stay empty. If computing a metric fails, it is
// left out and the exception is added to faults.
Measured Measure(const StackOutcome& outcome, const GroundTruth* truth, FirstFault& faults);

}  // namespace merlin
