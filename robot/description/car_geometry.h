// Derives from the car's links and its <drivetrain> element how the car drives and where its sensors are.
#pragma once

#include "robot/description/car_mapping.h"
#include "robot/description/urdf_source.h"
#include "robot/types/car.h"

namespace merlin {

// Fills in the roles and what follows from car.links: base, wheelbase, tracks, wheel radius, steering limit, sensor
// frames. The base follows from the wheels; if the URDF's root is elsewhere, a link for the base is added above the
// root. Throws InputError for a missing joint or frame, for one that is unfit for its role, and for wheels that are not
// those of a car.
void DeriveGeometry(const UrdfSource& source, const CarMapping& mapping, CarDescription& car);

// Throws InputError for a missing, not positive or not finite attribute, with its line.
Drivetrain ReadDrivetrain(const UrdfSource& source);

}  // namespace merlin
