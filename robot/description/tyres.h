// The tyres of a car: where their middles are and how large they are, from the wheels' shapes or from the mapping.
#pragma once

#include <Eigen/Core>

#include "robot/description/axles.h"
#include "robot/description/car_mapping.h"
#include "robot/description/link_tree.h"
#include "robot/types/car.h"

namespace merlin {

// The frame at a point whose z is the axle.
Pose AtAxle(const Eigen::Vector3d& middle, const Eigen::Vector3d& axis);

// Sets the wheels' tyres and their radius; returns their middles in the root's frame. Throws InputError for a tyre
// whose size is not given anywhere, whose radius differs from the first one's, or whose middle is not on its joint's
// axis.
Middles DeriveTyres(const UrdfSource& source, const CarMapping& mapping, LinkTree& tree, CarDescription& car);

}  // namespace merlin
