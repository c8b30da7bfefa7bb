// Where a camera cannot be: inside matter.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <optional>
#include <string>

namespace merlin {

// The name of a visible geom that holds this point, none if it lies in free space. A plane holds what is below it, a
// mesh what a ray leaves through an odd number of its triangles.
std::optional<std::string> GeomAround(const mjModel* model, const mjData* data, const Eigen::Vector3d& point_world);

// Whether there is anything to see.
bool HasVisibleGeom(const mjModel* model);

}  // namespace merlin
