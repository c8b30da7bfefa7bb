// Cuts a mesh into convex pieces. MuJoCo lets a mesh collide as its convex hull, and the hull of a room's shell would fill
// the room.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace merlin::sim {

// Triangles with outward normals (counter-clockwise seen from outside) [m].
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

// A hull that exceeds the mesh by no more than this fills no free space that matters.
constexpr double kHullExcess_m = 0.005;
// How thick a sheet is made, half to either side: a convex piece needs some volume.
constexpr double kSheet_m = 0.0004;

// The corners of convex bodies that together are the mesh, in the order of its triangles:
//  - each part (triangles connected by edges) that is closed, faces outward and is convex within kHullExcess_m and
//    has no other part within: its corners, a solid body;
//  - of each other part its surface: neighbouring triangles of one plane joined as long as they stay convex, each of these
//    polygons a sheet of kSheet_m. What such a part encloses is free, as it is seen.
// One piece with all corners: the mesh is convex, and MuJoCo's hull is the mesh. None: it would take more than most.
// Vertices within 1 um are one. Triangles without an area count for nothing.
std::optional<std::vector<std::vector<Eigen::Vector3d>>> ConvexPieces(const TriangleMesh& mesh, std::size_t most);

// Whether the mesh is one closed, convex part (see above).
bool IsConvex(const TriangleMesh& mesh);

}  // namespace merlin::sim
