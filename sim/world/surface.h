// Friction between the car's tyres and each floor.
#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "sim/world/materials.h"

namespace merlin::sim {

// Sets the friction of every floor to the tyre's friction times the grip of the floor's material. surface: the name of
// a material that replaces that of every floor; empty: each floor keeps its own. is_floor: indexed by geom id. tyre:
// the geom id of one of the car's tyres. Throws InputError if no material has the name, and suggests the nearest.
void SetGrip(mjModel* model, const std::vector<bool>& is_floor, int tyre, const Materials& materials,
             const std::string& surface);

}  // namespace merlin::sim
