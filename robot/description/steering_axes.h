// The joints that turn about an upright axis: the knuckles that steer the front wheels, and the pan unit of the
// cameras.
#pragma once

#include "robot/description/axles.h"
#include "robot/description/car_mapping.h"
#include "robot/description/link_tree.h"
#include "robot/types/car.h"

namespace merlin {

// A steering joint must be revolute. For a continuous joint, which has no limits, the mapping gives them; for a
// revolute one it may narrow them. Throws InputError for a joint without limits.
void LimitKnuckle(const UrdfSource& source, const CarMapping& mapping, CarLink& link);

// The track and the largest angle of the steering, as its limits allow. Needs the wheelbase and the wheels' radius.
// Throws InputError for axes that are not upright, not symmetric, or not where the wheels are.
void DeriveSteering(const UrdfSource& source, LinkTree& tree, const Pose& T_base_root, CarDescription& car,
                    Asymmetry& asymmetry);

// Finds the joint that turns the cameras, if the car has one. Its axis is upright, its angle positive to the left, and
// its link hangs on the base. Throws InputError for a joint that is unfit.
void DerivePan(const UrdfSource& source, const CarMapping& mapping, LinkTree& tree, const Pose& T_base_root,
               CarDescription& car);

}  // namespace merlin
