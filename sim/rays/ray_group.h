// The visible geoms of a MuJoCo model, as the ray caster needs them: grouped by what moves together.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <array>
#include <deque>
#include <vector>

#include "robot/types/se3.h"

namespace merlin::sim {

// A sphere, capsule, cylinder or ellipsoid: MuJoCo itself intersects it.
struct CurvedGeom {
  int geom;
  int type;
  mjtNum position[3];
  mjtNum rotation[9];
  mjtNum size[3];
};

// Half edges [m], in the geom's frame, of the smallest box around it.
Eigen::Vector3d HalfEdges(const CurvedGeom& curved);

// A plane that triangles of one geom share; in the group's frame.
struct RayFace {
  int geom = -1;
  Eigen::Vector3d normal{0, 0, 0};  // unit
  double offset_m = 0.0;            // normal . p of its points
};

// Geoms that move together. Flat ones are triangles in float; the frame is the body's (statics: the world's; a plane:
// its own, so that its far corners cost no precision).
struct RayGroup {
  int body = 0;
  Pose T_body_group = Pose::Identity();
  bool one_sided = false;  // a plane: MuJoCo's are seen from above only
  bool fixed = false;      // never moves, and its frame is the world's
  bool panes = false;      // geoms that can be looked through

  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<unsigned, 3>> triangles;
  std::vector<RayFace> faces;
  std::vector<int> face_of_triangle;  // index into faces
  std::vector<CurvedGeom> curved;

  // In the group's frame, about the middle of the smallest upright box around all its geoms.
  struct Sphere {
    Eigen::Vector3d middle{0, 0, 0};
    double radius_m = 0.0;
  };
  Sphere Around() const;
};

Pose ToPose(const mjtNum* position, const mjtNum* quaternion_wxyz);

// T_world_body of every body before anything has moved.
std::vector<Pose> ReferencePoses(const mjModel* model);

// One group of all statics, one for each body that moves, the same again for panes, one for each plane (in the world's
// frame if it is fixed and level: then its far corners cost no precision there either); without the
// geoms of bodies for which skip_body is true. is_pane: by geom, empty for none. Throws InputError for a geom of a type
// that is neither flat nor curved (height field, SDF).
std::deque<RayGroup> GroupGeoms(const mjModel* model, const std::vector<bool>& skip_body,
                                const std::vector<bool>& is_pane);

}  // namespace merlin::sim
