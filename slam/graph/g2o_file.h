// The text format of g2o (R. Kuemmerle et al., "g2o: a general framework for graph optimization", ICRA 2011):
//   VERTEX_SE2 id x y yaw                   VERTEX_SE3:QUAT id x y z qx qy qz qw
//   EDGE_SE2 from to x y yaw I11 I12 I13 I22 I23 I33
//   EDGE_SE3:QUAT from to x y z qx qy qz qw I11 I12 ... I66   (over translation and vector part of the quaternion)
//   FIX id ...                              # comment
//   PARAMS_... (sensors' places, which none of these edges uses; ignored)
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/graph/pose_graph.h"

namespace merlin {

struct G2oFile {
  PoseGraph graph{};                    // poses by ascending id; information over rotations [rad], see GraphEdge
  std::vector<std::int64_t> ids{};      // of the poses
  bool has_poses = false;               // false: the file has no VERTEX, and the poses are chained along the edges
  std::vector<std::string> warnings{};  // one sentence each, with lines
};

// Reads the whole text; name: the file's, for the errors. Throws InputError with every fault, each with name and line:
// a tag that is none of the above, a field that is missing, too much, no number or beyond 1e9 m and 1e15 of
// information, a quaternion of no length, an edge from a pose to itself or to one that is not there, a second VERTEX of
// one id, planar and spatial lines mixed; and for no edge at all. Warns of, and mends, quaternions off unit length
// (then normalised) and information matrices that are not positive semidefinite (then the nearest that is). Warns of
// edges said twice and of parts that no edge joins (parts.h).
G2oFile ParseG2o(std::string_view text, const std::string& name);

// Numbers so that they read back as the same bits (the information of rotations: once divided and multiplied by 4).
std::string ToG2o(const G2oFile& file);

}  // namespace merlin
