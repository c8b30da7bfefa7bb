// Reads and writes the text format of g2o (R. Kuemmerle et al., "g2o: a general framework for graph optimization", ICRA
// 2011):
//   VERTEX_SE2 id x y yaw                   VERTEX_SE3:QUAT id x y z qx qy qz qw
//   EDGE_SE2 from to x y yaw I11 I12 I13 I22 I23 I33
//   EDGE_SE3:QUAT from to x y z qx qy qz qw I11 I12 ... I66   (over translation and vector part of the quaternion)
//   FIX id ...                              # comment
//   PARAMS_... (mounting poses of sensors, which none of these edges uses; ignored)
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

// Parses the whole text; name: the file's, for the messages. Throws InputError with every fault, each with name and
// line:
//   - a tag that is none of the above; planar and spatial lines in one file
//   - a field that is missing, superfluous, no number, or too large (1e9 m, 1e15 of information); a quaternion of length 0
//   - an edge from a pose to itself, or to one that does not exist; a second VERTEX with the same id; no edge at all
// Repairs, with a warning, quaternions that are not of unit length (normalised) and information matrices that are not
// positive semidefinite (replaced by the nearest that is). Warns of repeated edges, and of parts that no edge joins.
G2oFile ParseG2o(std::string_view text, const std::string& name);

// Writes numbers so that they read back as the same bits (the information of rotations is divided and multiplied by 4).
std::string ToG2o(const G2oFile& file);

}  // namespace merlin
