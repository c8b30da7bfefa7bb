// Builds the car's bodies in a MuJoCo spec from its description: a body and shapes for each link, all named as in the
// URDF (a link that does not move becomes a body without a joint).
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"
#include "robot/types/se3.h"

namespace merlin::sim::car_body {

// Geom groups: what is seen, and what touches (not drawn, met by no camera ray).
constexpr int kVisualGroup = 1;
constexpr int kCollisionGroup = 3;

// Adds the car with a free joint at T_world_base to the world body; of its other joints only those of wheels,
// knuckles and of a pan unit that moves do. Materials that the spec does not have yet are added by name. A wheel touches the ground with an
// ellipsoid of the tyre's radius and width: a cylinder would touch with two points, which scrub in a turn.
void AddTo(mjSpec* spec, const CarDescription& car, const Pose& T_world_base);

// The wheel whose link has this place in car.links; null if it is none.
const CarWheel* FindWheel(const CarDescription& car, std::size_t link);

}  // namespace merlin::sim::car_body
