// From a scenario to the twin it asks for, and to the car as the stack knows it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "robot/twin/twin.h"
#include "scenarios/run/run.h"

namespace merlin {

// Throws InputError for what the scenario's parts do not allow: rates, settings, materials, files.
TwinOptions TwinOptionsOf(const Scenario& scenario, const RunOptions& options);

// The car as the stack knows it: its description, and what a calibration found better.
CarDescription BelievedCar(const CarChoice& choice);

// Takes out of the sensors the colour camera and the compass that the car does not have, with a warning for each. Throws
// InputError where the scenario requires colour.
void LeaveOutWhatTheCarLacks(const CarDescription& car, Sensors& sensors, std::vector<std::string>& warnings);

// Calls make with the options, colour included if this machine can draw it. Without GL a scenario that can do without
// colour goes on depth alone, and note says so; one that needs it throws MachineError.
void MakeWithColor(TwinOptions options, const Scenario& scenario, std::string& note,
                   const std::function<void(const TwinOptions&)>& make);

}  // namespace merlin
