// The joints that turn about an upright axis: the knuckles that steer the front wheels, and what turns the cameras.
#pragma once

#include "robot/description/axles.h"
#include "robot/description/car_mapping.h"
#include "robot/description/link_tree.h"
#include "robot/types/car.h"

namespace merlin {

// What steers is revolute; the mapping may give the limits that a continuous joint has not, or narrower ones. Throws
// InputError for a joint without limits.
void LimitKnuckle(const UrdfSource& source, const CarMapping& mapping, CarLink& link);

// The track and the largest angle of the steering, as its limits allow. Needs the wheelbase and the wheels' radius.
// Throws InputError for axes that are not upright, not symmetric, or not where the wheels are.
void DeriveSteering(const UrdfSource& source, LinkTree& tree, const Pose& T_base_root, CarDescription& car,
                    Asymmetry& asymmetry);

// The axis of the joint that turns the cameras, where the car has one: upright, positive to the left. Its link hangs on
// the base. Throws InputError for a joint that cannot.
void DerivePan(const UrdfSource& source, const CarMapping& mapping, LinkTree& tree, const Pose& T_base_root,
               CarDescription& car);

}  // namespace merlin
