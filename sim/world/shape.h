// The shapes of a model's geoms in the world: points all over a surface, and how far a point is from a solid.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <vector>

#include "sim/world/mesh_pieces.h"

namespace merlin::sim {

// Of a finite plane where it collides as it is seen, see sim/world/solid.h.
constexpr double kSlab_m = 0.05;

// In the geom's frame.
TriangleMesh MeshOf(const mjModel* model, int geom);

// Seen by the cameras: geom group 0-2 and not wholly transparent (the material's alpha counts where there is one).
bool IsSeen(const mjModel* model, int geom);

// Its name is floor*.
bool IsFloor(const mjModel* model, int geom);

// A plane that ends where it is seen to end: it has a size, is no floor*, and either collides with nothing or does
// not face up. MuJoCo's own planes, and so all others, are infinite for what touches them.
bool IsPanel(const mjModel* model, const mjData* data, int geom);

// Points on the geom's surface, a grid of 2.5 cm, coarser where that would be more than 64 of them along an edge; an
// infinite plane as far as 50 m. None for a height field or signed distance field. World frame.
std::vector<Eigen::Vector3d> PointsOn(const mjModel* model, const mjData* data, int geom);

// How far points are from one geom's matter; 0 inside. A plane's matter is all that lies below it (a panel's: kSlab_m),
// an ellipsoid's distance is approximate, a mesh is what its triangles enclose, not its hull.
class Solid {
 public:
  Solid(const mjModel* model, const mjData* data, int geom);
  int geom() const { return geom_; }
  // Exact up to max_m, beyond it any number above max_m.
  double Distance_m(const Eigen::Vector3d& point_world, double max_m) const;

 private:
  double ToMesh_m(const Eigen::Vector3d& p, double max_m) const;

  int geom_, type_;
  bool panel_;
  Eigen::Vector3d position_, size_;
  Eigen::Matrix3d R_world_geom_;
  double reach_m_;  // of the geom from its position; 0: no end
  TriangleMesh mesh_;
};

}  // namespace merlin::sim
