// Builds the car's bodies in a MuJoCo spec from its description: a body, joint and shapes for each link, all named as
// in the URDF (a fixed link becomes a body without a joint).
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"
#include "robot/types/se3.h"

namespace merlin::sim::car_body {

// Geom groups: what is seen, and what touches (not drawn, met by no camera ray).
constexpr int kVisualGroup = 1;
constexpr int kCollisionGroup = 3;

// Adds the car with a free joint at T_world_base to the world body. Materials that the spec does not have yet are added
// by name. The wheels' collision cylinders become ellipsoids of the same radius and width: a cylinder touches the
// ground with two points, which scrub in a turn.
void AddTo(mjSpec* spec, const CarDescription& car, const Pose& T_world_base);

// A link that rolls on the ground.
bool IsWheel(const CarLink& link);

}  // namespace merlin::sim::car_body
