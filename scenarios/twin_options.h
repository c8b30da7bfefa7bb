// From a scenario to the twin it asks for, and to the car as the stack knows it.
#pragma once

#include <functional>
#include <string>

#include "robot/twin/twin.h"
#include "scenarios/run.h"

namespace merlin {

// Throws InputError for what the scenario's parts do not allow: rates, settings, materials, files.
TwinOptions TwinOptionsOf(const Scenario& scenario, const RunOptions& options);

// The car as the stack knows it: its description, and what a calibration found better.
CarDescription BelievedCar(const CarChoice& choice);

// Calls make with the options, colour included if this machine can draw it. Without GL a scenario that can do without
// colour goes on depth alone, and note says so; one that needs it throws MachineError.
void MakeWithColor(TwinOptions options, const Scenario& scenario, std::string& note,
                   const std::function<void(const TwinOptions&)>& make);

}  // namespace merlin
