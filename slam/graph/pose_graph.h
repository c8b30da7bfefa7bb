// A graph of poses, and of the relations measured between them (F. Lu and E. Milios, "Globally consistent range scan
// alignment for environment mapping", Autonomous Robots 4, 1997; also "Autonomous navigation and mapping of mobile
// robots based on 2D/3D cameras combination", thesis, University of Siegen, about 2011, eq. 5.1-5.10).
#pragma once

#include <cstddef>
#include <vector>

#include "robot/types/se3.h"

namespace merlin {

struct GraphEdge {
  std::size_t from = 0, to = 0;       // indices into PoseGraph::poses, not the same
  Pose T_from_to = Pose::Identity();  // as measured
  // Inverse covariance of the error E = T_from_to^-1 (T_from^-1 T_to), over (translation [m], rotation [rad]) in the
  // frame of `to`; symmetric, positive semidefinite. The rotation is 2 sin(angle / 2) times the axis, as in g2o; for
  // small angles this is the rotation vector. In planar graphs only x, y and yaw count.
  Matrix6d information = Matrix6d::Identity();
  bool robust = false;  // may be wrong (a loop closure): it loses weight where it contradicts the others
};

struct PoseGraph {
  std::vector<Pose> poses{};  // T_map_pose
  std::vector<GraphEdge> edges{};
  std::vector<std::size_t> fixed{};  // indices of the poses that stay; empty: the first stays
  bool planar = false;               // SE(2): poses and edges are x, y and yaw; the rest counts as zero
};

}  // namespace merlin
