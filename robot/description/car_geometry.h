// What the car's links and its <drivetrain> element say about how it drives and where its sensors are.
#pragma once

#include "robot/description/car_mapping.h"
#include "robot/description/urdf_source.h"
#include "robot/types/car.h"

namespace merlin {

// Fills in the roles and what car.links imply of them: base, wheelbase, tracks, wheel radius, steering limit, sensor
// frames. The base follows from the wheels; where the URDF's root is elsewhere, a link for it is put above the root.
// Throws InputError for a missing joint or frame, one that cannot play its role, and for wheels that make no car.
void DeriveGeometry(const UrdfSource& source, const CarMapping& mapping, CarDescription& car);

// Throws InputError for a missing, not positive or not finite attribute, with its line.
Drivetrain ReadDrivetrain(const UrdfSource& source);

}  // namespace merlin
