// What the car's links and its <drivetrain> element say about how it drives and where its sensors are.
#pragma once

#include "robot/description/urdf_source.h"
#include "robot/types/car.h"

namespace merlin {

// Fills in what car.links imply: wheelbase, track, wheel radius, steering limit, sensor frames. Throws InputError for a
// missing wheel or frame, and for wheels that disagree with each other or with base_link.
void DeriveGeometry(const UrdfSource& source, CarDescription& car);

// Throws InputError for a missing, not positive or not finite attribute, with its line.
Drivetrain ReadDrivetrain(const UrdfSource& source);

}  // namespace merlin
