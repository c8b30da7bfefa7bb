// Builds the car's bodies in a MuJoCo spec from its description. Each link becomes a body of the same name with its
// shapes; a fixed link becomes a body without a joint.
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"
#include "robot/types/se3.h"

namespace merlin::sim::car_body {

// Geom groups of visual shapes, and of collision shapes (which are not drawn and which camera rays ignore).
constexpr int kVisualGroup = 1;
constexpr int kCollisionGroup = 3;

// Adds the car to the world body, with a free joint at T_world_base. Of its other joints only those of the wheels, the
// knuckles and a movable pan unit move. Materials that the spec lacks are added by name. A wheel touches the ground
// with an ellipsoid of the tyre's radius and width: a cylinder would touch at two points, which scrub in a turn.
void AddTo(mjSpec* spec, const CarDescription& car, const Pose& T_world_base);

// The wheel whose link has this index in car.links; null if that link is not a wheel.
const CarWheel* FindWheel(const CarDescription& car, std::size_t link);

}  // namespace merlin::sim::car_body
