// The car as the stack knows it, and which of a scenario's sensors it has.
#pragma once

#include <string>
#include <vector>

#include "robot/types/car.h"
#include "scenarios/config/scenario.h"

namespace merlin {

// The car's description, corrected by the calibration file if there is one.
CarDescription BelievedCar(const CarChoice& choice);

// Removes the colour camera and the compass from the sensors if the car does not have them, with a warning for each.
// Throws InputError if the scenario requires colour.
void LeaveOutWhatTheCarLacks(const CarDescription& car, Sensors& sensors, std::vector<std::string>& warnings);

}  // namespace merlin
