// Geometry of a model's geoms: sample points on a surface, and the distance of a point from a solid.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <vector>

#include "sim/world/mesh_pieces.h"

namespace merlin::sim {

// Thickness of the slab as which a panel collides (sim/world/solid.h).
constexpr double kSlab_m = 0.05;

// The triangles of a mesh geom, in the geom's frame.
TriangleMesh MeshOf(const mjModel* model, int geom);

// Whether the cameras see the geom: its group is 0 to 2 and its alpha (of its material, if it has one) is above 0.
bool IsSeen(const mjModel* model, int geom);

// Whether its name begins with "floor".
bool IsFloor(const mjModel* model, int geom);

// Whether a plane counts as a finite panel: it has a size, is not named floor*, and either has no contact bits or does
// not face up. All other planes are infinite in contacts, as MuJoCo treats them.
bool IsPanel(const mjModel* model, const mjData* data, int geom);

// Points on the geom's surface in the world frame, in a grid of 2.5 cm or of 64 steps along an edge, whichever is
// coarser. An infinite plane is sampled to 50 m from its origin. Empty for a height field or signed distance field.
std::vector<Eigen::Vector3d> PointsOn(const mjModel* model, const mjData* data, int geom);

// A geom as a solid body, for distances. A plane is solid everywhere below its surface, a panel down to kSlab_m. A mesh
// is the volume that its triangles enclose, not their hull. The distance from an ellipsoid is approximate.
class Solid {
 public:
  Solid(const mjModel* model, const mjData* data, int geom);
  int geom() const { return geom_; }
  // 0 inside. Exact up to max_m; for points farther away, any number above max_m.
  double Distance_m(const Eigen::Vector3d& point_world, double max_m) const;

 private:
  double ToMesh_m(const Eigen::Vector3d& p, double max_m) const;

  int geom_, type_;
  bool panel_;
  Eigen::Vector3d position_, size_;
  Eigen::Matrix3d R_world_geom_;
  double reach_m_;  // radius of the sphere around its position that holds the geom; 0: infinite
  TriangleMesh mesh_;
};

}  // namespace merlin::sim
