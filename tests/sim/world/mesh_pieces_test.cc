#include "sim/world/mesh_pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace merlin::sim {
namespace {

void AddBox(TriangleMesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  constexpr int kFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const auto& f : kFaces) mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
}

TriangleMesh Box() {
  TriangleMesh mesh;
  AddBox(mesh, {0, 0, 0}, {3, 2, 1});
  return mesh;
}

// An L of 2 x 2 m, 1 m wide, 0.5 m high: its top and bottom are not convex.
TriangleMesh Angle() {
  const Eigen::Vector2d outline[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  TriangleMesh mesh;
  for (const double z : {0.0, 0.5})
    for (const Eigen::Vector2d& p : outline) mesh.vertices.emplace_back(p.x(), p.y(), z);
  for (int i = 0; i < 6; ++i) {
    const int k = (i + 1) % 6;
    mesh.triangles.push_back({i, k, k + 6});
    mesh.triangles.push_back({i, k + 6, i + 6});
  }
  for (const std::array<int, 3>& t : {std::array{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}}) {
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
    mesh.triangles.push_back({t[0], t[2], t[1]});
  }
  return mesh;
}

TEST(MeshPieces, ABoxIsConvex) {
  EXPECT_TRUE(IsConvex(Box()));
  const auto pieces = ConvexPieces(Box(), 10);
  ASSERT_TRUE(pieces);
  ASSERT_EQ(pieces->size(), 1u);
  EXPECT_EQ(pieces->front().size(), 8u);
}

TEST(MeshPieces, EqualVerticesAreMerged) {  // as in STL, where each triangle has three vertices of its own
  TriangleMesh loose;
  for (const auto& t : Box().triangles) {
    const int first = static_cast<int>(loose.vertices.size());
    for (const int corner : t) loose.vertices.push_back(Box().vertices[corner]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(IsConvex(loose));
}

TEST(MeshPieces, ABoxWithoutALidIsFiveSheets) {
  TriangleMesh open = Box();
  open.triangles.erase(open.triangles.begin() + 2, open.triangles.begin() + 4);
  EXPECT_FALSE(IsConvex(open));
  const auto pieces = ConvexPieces(open, 10);
  ASSERT_TRUE(pieces);
  EXPECT_EQ(pieces->size(), 5u);
  for (const auto& piece : *pieces) {
    EXPECT_EQ(piece.size(), 8u);  // the corners of a rectangle, on both sides
    double thinnest_m = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      double low = 1e9, high = -1e9;
      for (const auto& corner : piece) low = std::min(low, corner[axis]), high = std::max(high, corner[axis]);
      thinnest_m = std::min(thinnest_m, high - low);
    }
    EXPECT_NEAR(thinnest_m, kSheet_m, 1e-12);
  }
}

TEST(MeshPieces, ABoxInsideOutEnclosesFreeSpace) {
  TriangleMesh room = Box();
  for (auto& t : room.triangles) std::swap(t[1], t[2]);
  EXPECT_FALSE(IsConvex(room));
  EXPECT_EQ(ConvexPieces(room, 10)->size(), 6u);
}

TEST(MeshPieces, EachConvexPartIsABody) {
  TriangleMesh mesh = Box();
  AddBox(mesh, {5, 0, 0}, {6, 1, 1});
  AddBox(mesh, {2, 1, 0.5}, {4, 3, 2});  // overlaps the first
  EXPECT_FALSE(IsConvex(mesh));
  EXPECT_EQ(ConvexPieces(mesh, 10)->size(), 3u);
  EXPECT_FALSE(ConvexPieces(mesh, 2));
}

TEST(MeshPieces, AHollowBoxIsTwoShells) {  // the outside of a building, and the inside of its room
  TriangleMesh hollow;
  AddBox(hollow, {0, 0, 0}, {2, 1, 1});
  for (auto& t : hollow.triangles) std::swap(t[1], t[2]);
  AddBox(hollow, {-0.1, -0.1, -0.1}, {2.1, 1.1, 1.1});
  EXPECT_FALSE(IsConvex(hollow));
  EXPECT_EQ(ConvexPieces(hollow, 20)->size(), 12u);
}

TEST(MeshPieces, SheetsOfAnAngleCoverItsSurfaceAndNothingElse) {
  EXPECT_FALSE(IsConvex(Angle()));
  const auto pieces = ConvexPieces(Angle(), 100);
  ASSERT_TRUE(pieces);
  EXPECT_GE(pieces->size(), 10u);  // six sides, and top and bottom in two each
  EXPECT_LE(pieces->size(), 12u);  // or three
  double area_m2 = 0.0;
  for (const auto& piece : *pieces) {
    // The first half of its corners is the polygon, in order: shoelace formula in three dimensions.
    Eigen::Vector3d twice(0, 0, 0);
    for (std::size_t i = 0, n = piece.size() / 2; i < n; ++i) twice += piece[i].cross(piece[(i + 1) % n]);
    area_m2 += 0.5 * twice.norm();
    for (const auto& corner : piece)  // no corner lies in the notch
      EXPECT_FALSE(corner.x() > 1.001 && corner.y() > 1.001);
  }
  EXPECT_NEAR(area_m2, 2 * 3.0 + 8.0 * 0.5, 1e-2);
}

TEST(MeshPieces, ARoundBodyIsConvexAndADentOfACentimetreIsNot) {
  TriangleMesh ball;
  constexpr int kRings = 20, kAround = 40;
  for (int i = 0; i <= kRings; ++i)
    for (int k = 0; k < kAround; ++k) {
      const double polar = std::numbers::pi * i / kRings, azimuth = 2 * std::numbers::pi * k / kAround;
      ball.vertices.emplace_back(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                 std::cos(polar));
    }
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kAround; ++k) {
      const int a = i * kAround + k, b = i * kAround + (k + 1) % kAround;
      ball.triangles.push_back({a, a + kAround, b + kAround});
      ball.triangles.push_back({a, b + kAround, b});
    }
  EXPECT_TRUE(IsConvex(ball));
  ball.vertices[10 * kAround] *= 0.95;
  EXPECT_FALSE(IsConvex(ball));
}

TEST(MeshPieces, AnEmptyMeshHasNoPieces) {
  EXPECT_FALSE(IsConvex({}));
  EXPECT_TRUE(ConvexPieces({}, 10)->empty());
  // A triangle without area is ignored.
  EXPECT_TRUE(ConvexPieces({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, 10)->empty());
  EXPECT_EQ(ConvexPieces({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, 10)->size(), 1u);
}

}  // namespace
}  // namespace merlin::sim
