// What a car can do at most, and how fast it may be so that it still stops in time.
#pragma once

#include "robot/types/car.h"
#include "robot/types/measurements.h"

namespace merlin {

// The nearest angle that the virtual front wheel can be turned to.
double ClampSteering_rad(const CarDescription& car, double wheels_rad);

// The nearest command that the car can follow: speed and steering clamped to its limits. Both must be finite.
DriveCommand ClampCommand(const CarDescription& car, const DriveCommand& command);

// The highest speed [m/s] from which a car that brakes evenly stands after a distance: v^2 = 2 a s. 0 for a distance that is
// not positive.
double SpeedToStopWithin_m_s(double distance_m, double deceleration_m_s2);

}  // namespace merlin
