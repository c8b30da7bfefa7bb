// How much grip the car's tyres have on each floor.
#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "sim/world/materials.h"

namespace merlin::sim {

// Gives every floor (by geom) the friction tyres have on it: tyre friction times the grip of its material, or of the
// surface named for all of them (empty: each its own). tyre: a geom of the car's tyres. Throws InputError for a surface
// that is not among the materials, naming the nearest.
void SetGrip(mjModel* model, const std::vector<bool>& is_floor, int tyre, const Materials& materials,
             const std::string& surface);

}  // namespace merlin::sim
