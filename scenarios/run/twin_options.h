// Turns a scenario into the options of its twin.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "robot/twin/twin.h"
#include "scenarios/config/believed_car.h"
#include "scenarios/run/run.h"

namespace merlin {

// Throws InputError for rates, settings, materials or files that the scenario's parts do not allow.
TwinOptions TwinOptionsOf(const Scenario& scenario, const RunOptions& options);

// Calls make with the options, with colour if this machine can draw. Without GL, a scenario that does not require
// colour runs with depth only, and note says so; for one that does, throws MachineError.
void MakeWithColor(TwinOptions options, const Scenario& scenario, std::string& note,
                   const std::function<void(const TwinOptions&)>& make);

// Throws InputError if a check compares the map with the plan and the room has none.
void RequirePlan(const Scenario& scenario, const sim::World& world);

// Notes to the user, one sentence each: why there is no colour (without_color, may be empty), and the room's warnings.
std::vector<std::string> NotesOf(const std::string& without_color, const sim::World& world);

}  // namespace merlin
