// The behaviours that a scenario may name: the one place that lists them.
#pragma once

#include <string>
#include <vector>

#include "autonomy/behaviors/behavior.h"
#include "autonomy/behaviors/follow_corridor.h"
#include "autonomy/task.h"

namespace merlin {

// The configs of all behaviours that have keys of their own in a scenario file.
struct BehaviorConfig {
  FollowCorridorConfig follow_corridor;
};

template <class Visitor>
void Visit(Visitor& v, BehaviorConfig& c) {
  Visit(v, c.follow_corridor);  // its keys stand directly below `pilot`, where they have always been
}

struct BehaviorInfo {
  std::string name;         // in a scenario file
  std::string description;  // one whole sentence of what the car does
  std::string former_name;  // still accepted, with a warning; empty: none
  bool on_turntable;        // a turntable turns the car, which only the twin has; the car does not drive
  Behavior (*make)(const Task& task, const BehaviorConfig& config);
};

const std::vector<BehaviorInfo>& Behaviors();
std::vector<std::string> BehaviorNames();

// By its name or its former name. Null: there is none of that name.
const BehaviorInfo* FindBehavior(const std::string& name);

// Whether a task is done on a turntable.
bool IsOnTurntable(const Task& task);

}  // namespace merlin
