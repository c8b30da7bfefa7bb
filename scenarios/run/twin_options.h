// From a scenario to the twin it asks for.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "robot/twin/twin.h"
#include "scenarios/config/believed_car.h"
#include "scenarios/run/run.h"

namespace merlin {

// Throws InputError for what the scenario's parts do not allow: rates, settings, materials, files.
TwinOptions TwinOptionsOf(const Scenario& scenario, const RunOptions& options);

// Calls make with the options, colour included if this machine can draw it. Without GL a scenario that can do without
// colour goes on depth alone, and note says so; one that needs it throws MachineError.
void MakeWithColor(TwinOptions options, const Scenario& scenario, std::string& note,
                   const std::function<void(const TwinOptions&)>& make);

// Throws InputError where a check compares the map with the plan, and the room has none.
void RequirePlan(const Scenario& scenario, const sim::World& world);

// Why there are no colours (empty: there are), and what the room's reader warned of; one sentence each.
std::vector<std::string> NotesOf(const std::string& without_color, const sim::World& world);

}  // namespace merlin
