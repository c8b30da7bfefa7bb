// Cuts a mesh into convex pieces. MuJoCo collides a mesh as its convex hull, which for the mesh of a whole room would
// fill the room.
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

// A part whose hull extends beyond it by no more than this counts as convex.
constexpr double kHullExcess_m = 0.005;
// Thickness of a sheet, half on each side of its plane: a convex piece needs some volume.
constexpr double kSheet_m = 0.0004;

// The corners of convex bodies that together make up the mesh, in the order of its triangles. A part is a set of
// triangles connected by edges.
//  - A part that is closed, faces outward, is convex within kHullExcess_m and holds no other part becomes one solid
//    body.
//  - Of any other part only the surface becomes solid: neighbouring triangles in one plane are joined while their union
//    stays convex, and each polygon becomes a sheet of thickness kSheet_m. The space that such a part encloses stays
//    free.
// A convex mesh gives one piece with all corners. None if there would be more pieces than max_pieces. Vertices within
// 1 um of each other are merged; triangles without area are ignored.
std::optional<std::vector<std::vector<Eigen::Vector3d>>> ConvexPieces(const TriangleMesh& mesh, std::size_t max_pieces);

// Whether the mesh is one closed, convex part (see above).
bool IsConvex(const TriangleMesh& mesh);

}  // namespace merlin::sim
