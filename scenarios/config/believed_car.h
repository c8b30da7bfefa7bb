// The car as the stack knows it, and what of a scenario's sensors it has.
#pragma once

#include <string>
#include <vector>

#include "robot/types/car.h"
#include "scenarios/config/scenario.h"

namespace merlin {

// The car's description, and what a calibration found better.
CarDescription BelievedCar(const CarChoice& choice);

// Takes out of the sensors the colour camera and the compass that the car does not have, with a warning for each. Throws
// InputError where the scenario requires colour.
void LeaveOutWhatTheCarLacks(const CarDescription& car, Sensors& sensors, std::vector<std::string>& warnings);

}  // namespace merlin
