// Checks that a camera stands in free space, not inside a body.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <optional>
#include <string>

namespace merlin {

// The name of a visible geom that contains this point; none if the point lies in free space. A plane contains everything
// below it. A mesh contains a point if a ray from there crosses an odd number of its triangles.
std::optional<std::string> GeomAround(const mjModel* model, const mjData* data, const Eigen::Vector3d& point_world);

// Whether the model has any visible geom.
bool HasVisibleGeom(const mjModel* model);

}  // namespace merlin
