#include "autonomy/behaviors/table.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "autonomy/behaviors/turn_on_turntable.h"

namespace merlin {
namespace {

// Any class that has the method Decide.
template <class Decides>
Behavior AsBehavior(Decides behavior) {
  return [behavior = std::move(behavior)](const Situation& situation) mutable { return behavior.Decide(situation); };
}

Behavior MakeFollowCorridor(const Task& task, const BehaviorConfig& config) {
  return AsBehavior(FollowCorridor(task.laps, config.follow_corridor));
}

Behavior MakeTurnOnTurntable(const Task& task, const BehaviorConfig&) {
  return AsBehavior(TurnOnTurntable({.angle_rad = task.angle_deg * std::numbers::pi / 180.0}));
}

}  // namespace

const std::vector<BehaviorInfo>& Behaviors() {
  static const std::vector<BehaviorInfo> table{
      {.name = "follow_corridor",
       .description = "The car drives in the middle of a corridor and around its corners, for so many laps.",
       .former_name = "",
       .on_turntable = false,
       .make = MakeFollowCorridor},
      {.name = "turn_on_turntable",
       .description = "The car stands on a turntable that turns it through an angle.",
       .former_name = "turn_on_stand",
       .on_turntable = true,
       .make = MakeTurnOnTurntable},
  };
  return table;
}

std::vector<std::string> BehaviorNames() {
  std::vector<std::string> names;
  for (const BehaviorInfo& behavior : Behaviors()) names.push_back(behavior.name);
  return names;
}

const BehaviorInfo* FindBehavior(const std::string& name) {
  const auto found = std::ranges::find_if(Behaviors(), [&name](const BehaviorInfo& behavior) {
    return behavior.name == name || (!name.empty() && behavior.former_name == name);
  });
  return found == Behaviors().end() ? nullptr : &*found;
}

bool IsOnTurntable(const Task& task) {
  const BehaviorInfo* const behavior = FindBehavior(task.behavior);
  return behavior != nullptr && behavior->on_turntable;
}

}  // namespace merlin
