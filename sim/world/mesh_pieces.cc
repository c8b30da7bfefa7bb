#include "sim/world/mesh_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace merlin::sim {
namespace {

constexpr double kWeld_m = 1e-6;
constexpr double kAreaMin_m2 = 1e-9;
constexpr double kPlane_m = 2e-4;          // largest distance of a polygon's corners from its plane
constexpr double kPlaneCosine = 1 - 1e-5;  // triangles of one polygon differ in direction by 0.26 deg at most
constexpr double kConvexShare = 1e-6;      // share by which a hull's area may exceed that of its polygons

using Corners = std::vector<Eigen::Vector3d>;
using Triangle = std::array<int, 3>;

class Groups {  // union-find; the smallest member represents its group
 public:
  explicit Groups(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  int Of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(int a, int b) {
    a = Of(a), b = Of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

Eigen::Vector3d TwiceArea(const Corners& vertices, const Triangle& t) {
  return (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
}

// Merges vertices at the same place and drops triangles without area.
TriangleMesh Weld(const TriangleMesh& mesh) {
  TriangleMesh welded;
  std::map<std::array<long long, 3>, int> known;
  std::vector<int> number;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const std::array<long long, 3> cell{std::llround(v.x() / kWeld_m), std::llround(v.y() / kWeld_m),
                                        std::llround(v.z() / kWeld_m)};
    const auto [found, is_new] = known.try_emplace(cell, static_cast<int>(welded.vertices.size()));
    if (is_new) welded.vertices.push_back(v);
    number.push_back(found->second);
  }
  for (const Triangle& t : mesh.triangles) {
    const Triangle to{number[t[0]], number[t[1]], number[t[2]]};
    if (TwiceArea(welded.vertices, to).norm() > 2 * kAreaMin_m2) welded.triangles.push_back(to);
  }
  return welded;
}

struct Edge {
  std::vector<int> triangles;
  int balance =
      0;  // +1 for each triangle that traverses it from the lower to the higher vertex index, -1 for the reverse
};
using Edges = std::map<std::pair<int, int>, Edge>;

Edges EdgesOf(const TriangleMesh& mesh) {
  Edges edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      Edge& edge = edges[std::minmax(a, b)];
      edge.triangles.push_back(static_cast<int>(i));
      edge.balance += a < b ? 1 : -1;
    }
  return edges;
}

// An edge shared by two triangles.
struct Border {
  double length_m;
  int a, b;
};

// Triangles connected by edges. Closed: every edge has exactly two triangles, which traverse it in opposite directions.
struct Part {
  std::vector<int> triangles;
  std::vector<Border> borders;
  bool closed = true;
};

std::vector<Part> PartsOf(const TriangleMesh& mesh, const Edges& edges) {
  Groups groups(mesh.triangles.size());
  for (const auto& [ends, edge] : edges)
    for (const int triangle : edge.triangles) groups.Join(edge.triangles[0], triangle);
  std::map<int, Part> parts;
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) parts[groups.Of(i)].triangles.push_back(i);
  for (const auto& [ends, edge] : edges) {
    Part& part = parts[groups.Of(edge.triangles[0])];
    if (edge.triangles.size() != 2 || edge.balance != 0) part.closed = false;
    if (edge.triangles.size() == 2)
      part.borders.push_back(
          {(mesh.vertices[ends.first] - mesh.vertices[ends.second]).norm(), edge.triangles[0], edge.triangles[1]});
  }
  std::vector<Part> in_order;
  for (auto& [first, part] : parts) in_order.push_back(std::move(part));
  return in_order;
}

Corners CornersOf(const TriangleMesh& mesh, const Part& part) {
  std::vector<int> numbers;
  for (const int t : part.triangles) numbers.insert(numbers.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  Corners corners;
  for (const int number : numbers) corners.push_back(mesh.vertices[number]);
  return corners;
}

// Whether no corner lies outside a face of the part by more than kHullExcess_m.
bool IsBehind(const TriangleMesh& mesh, const Part& body, const Corners& corners) {
  return std::ranges::all_of(body.triangles, [&](int t) {
    const Eigen::Vector3d normal = TwiceArea(mesh.vertices, mesh.triangles[t]).normalized();
    const double limit_m = normal.dot(mesh.vertices[mesh.triangles[t][0]]) + kHullExcess_m;
    return std::ranges::all_of(corners, [&](const Eigen::Vector3d& corner) { return normal.dot(corner) <= limit_m; });
  });
}

bool IsSolidBody(const TriangleMesh& mesh, const Part& part, const Corners& corners) {
  return part.closed && IsBehind(mesh, part, corners);
}

// A convex polygon in a plane.
struct Polygon {
  Corners corners;
  Eigen::Vector3d normal;
  double area_m2;
};

// Convex hull of the corners projected along the normal (Andrew, Information Processing Letters 9(5), 1979).
Polygon HullInPlane(const Corners& corners, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  struct Seen {
    double x, y;
    std::size_t corner;
  };
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < corners.size(); ++i) seen.push_back({u.dot(corners[i]), v.dot(corners[i]), i});
  std::ranges::sort(seen, [](const Seen& a, const Seen& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  const auto cross = [](const Seen& o, const Seen& a, const Seen& b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
  };
  std::vector<Seen> hull;
  for (const int pass : {0, 1}) {  // first the lower chain, then the upper one from right to left
    const std::size_t from = hull.size();
    for (const Seen& point : seen) {
      while (hull.size() >= from + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0.0) hull.pop_back();
      hull.push_back(point);
    }
    if (pass == 0) std::ranges::reverse(seen);
    hull.pop_back();  // it is the first point of the other chain
  }
  Polygon polygon{.corners = {}, .normal = normal, .area_m2 = 0.0};
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Seen &a = hull[i], &b = hull[(i + 1) % hull.size()];
    polygon.area_m2 += 0.5 * (a.x * b.y - a.y * b.x);
    polygon.corners.push_back(corners[a.corner]);
  }
  return polygon;
}

// The union of both polygons, if they lie in one plane and it is convex.
std::optional<Polygon> Joined(const Polygon& a, const Polygon& b) {
  if (a.normal.dot(b.normal) < kPlaneCosine) return std::nullopt;
  const double offset_m = a.normal.dot(a.corners[0]);
  for (const Polygon* polygon : {&a, &b})
    for (const Eigen::Vector3d& corner : polygon->corners)
      if (std::abs(a.normal.dot(corner) - offset_m) > kPlane_m) return std::nullopt;
  Corners both = a.corners;
  both.insert(both.end(), b.corners.begin(), b.corners.end());
  Polygon joined = HullInPlane(both, a.normal);
  const double sum_m2 = a.area_m2 + b.area_m2;
  if (joined.area_m2 > sum_m2 * (1 + kConvexShare)) return std::nullopt;
  return joined;
}

// Joins neighbouring triangles into convex polygons, across the longest edges first, until no two can be joined.
std::vector<Polygon> PolygonsOf(const TriangleMesh& mesh, const Part& part) {
  std::map<int, Polygon> polygons;
  for (const int t : part.triangles) {
    const Triangle& corners = mesh.triangles[t];
    polygons.emplace(t, HullInPlane({mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]},
                                    TwiceArea(mesh.vertices, corners).normalized()));
  }
  std::vector<Border> borders = part.borders;
  std::ranges::stable_sort(borders, std::greater{}, &Border::length_m);
  std::map<int, int> joined_to;  // a polygon that is gone, and the one that took it over
  const auto polygon_of = [&](int t) {
    while (joined_to.contains(t)) t = joined_to.at(t);
    return t;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const Border& border : borders) {
      const auto [a, b] = std::minmax({polygon_of(border.a), polygon_of(border.b)});
      if (a == b) continue;
      std::optional<Polygon> joined = Joined(polygons.at(a), polygons.at(b));
      if (!joined) continue;
      polygons.at(a) = std::move(*joined);
      polygons.erase(b);
      joined_to[b] = a;
      changed = true;
    }
  }
  std::vector<Polygon> in_order;
  for (auto& [first, polygon] : polygons) in_order.push_back(std::move(polygon));
  return in_order;
}

Corners Sheet(const Polygon& polygon) {
  Corners corners;
  for (const double side : {-0.5, 0.5})
    for (const Eigen::Vector3d& corner : polygon.corners) corners.push_back(corner + side * kSheet_m * polygon.normal);
  return corners;
}

}  // namespace

std::optional<std::vector<Corners>> ConvexPieces(const TriangleMesh& mesh, std::size_t max_pieces) {
  const TriangleMesh welded = Weld(mesh);
  const std::vector<Part> parts = PartsOf(welded, EdgesOf(welded));
  if (parts.size() > max_pieces) return std::nullopt;
  std::vector<Corners> corners;
  for (const Part& part : parts) corners.push_back(CornersOf(welded, part));
  std::vector<Corners> pieces;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const auto encloses = [&](const Corners& other) { return &other != &corners[i] && IsBehind(welded, part, other); };
    if (IsSolidBody(welded, part, corners[i]) && std::ranges::none_of(corners, encloses)) {
      pieces.push_back(corners[i]);
    } else {
      for (const Polygon& polygon : PolygonsOf(welded, part)) pieces.push_back(Sheet(polygon));
    }
    if (pieces.size() > max_pieces) return std::nullopt;
  }
  return pieces;
}

bool IsConvex(const TriangleMesh& mesh) {
  const TriangleMesh welded = Weld(mesh);
  const std::vector<Part> parts = PartsOf(welded, EdgesOf(welded));
  return parts.size() == 1 && IsSolidBody(welded, parts[0], CornersOf(welded, parts[0]));
}

}  // namespace merlin::sim
