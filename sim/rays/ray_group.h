// The visible geoms of a MuJoCo model, grouped by what moves together, for the ray caster.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <deque>
#include <vector>

#include "robot/types/se3.h"

namespace merlin::sim {

// A sphere, capsule, cylinder or ellipsoid, which MuJoCo itself intersects.
struct CurvedGeom {
  int geom;
  int type;
  mjtNum position[3];
  mjtNum rotation[9];
  mjtNum size[3];
};

// Half dimensions [m], in the geom's frame, of its bounding box.
Eigen::Vector3d HalfEdges(const CurvedGeom& curved);

// A plane that triangles of one geom share; in the group's frame.
struct RayFace {
  int geom = -1;
  Eigen::Vector3d normal{0, 0, 0};  // unit
  double offset_m = 0.0;            // normal . p of its points
};

// Geoms that move together. Flat geoms are triangles in float. The frame is that of the body; for static geoms that of
// the world; for a plane its own, so that its far corners lose no precision.
struct RayGroup {
  int body = 0;
  Pose T_body_group = Pose::Identity();
  bool one_sided = false;  // a plane: visible only from above, as in MuJoCo
  bool fixed = false;      // never moves, and its frame is the world's
  bool panes = false;      // geoms that can be looked through

  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<unsigned, 3>> triangles;
  std::vector<RayFace> faces;
  std::vector<int> face_of_triangle;  // index into faces
  std::vector<CurvedGeom> curved;

  // Sphere in the group's frame, centred in the axis-aligned bounding box of all its geoms.
  struct Sphere {
    Eigen::Vector3d middle{0, 0, 0};
    double radius_m = 0.0;
  };
  Sphere Around() const;
};

Pose ToPose(const mjtNum* position, const mjtNum* quaternion_wxyz);

// T_world_body of every body in the model's reference pose.
std::vector<Pose> ReferencePoses(const mjModel* model);

// Makes one group of all static geoms, one for each body that moves, the same again for panes, and one for each plane
// (in the world frame if it is fixed and level, because its far corners then lose no precision there either). Geoms of
// bodies for which skip_body is true are left out. is_pane: indexed by geom id; empty: no panes. Throws InputError for
// a geom that is neither flat nor curved (height field, SDF).
std::deque<RayGroup> GroupGeoms(const mjModel* model, const std::vector<bool>& skip_body,
                                const std::vector<bool>& is_pane);

}  // namespace merlin::sim
