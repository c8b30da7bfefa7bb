#include "sim/world/shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace merlin::sim {
namespace {

constexpr double kGrid_m = 0.025;
constexpr int kGridMax = 64;
constexpr double kSampledPlane_m = 50.0;
constexpr double kFacesUp = 0.7;  // a plane whose normal has a larger z faces up

using Points = std::vector<Eigen::Vector3d>;

int Steps(double length_m) { return std::clamp(static_cast<int>(std::ceil(length_m / kGrid_m)), 1, kGridMax); }

// Adds points centre + a u + b v for a, b in [-1, 1].
void AddRectangle(Points& points, const Eigen::Vector3d& centre, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  const int m = Steps(2 * u.norm()), n = Steps(2 * v.norm());
  for (int i = 0; i <= m; ++i)
    for (int k = 0; k <= n; ++k) points.push_back(centre + (2.0 * i / m - 1) * u + (2.0 * k / n - 1) * v);
}

void AddBox(Points& points, const Eigen::Vector3d& size) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto edge = [&](int k) -> Eigen::Vector3d { return size[k % 3] * Eigen::Vector3d::Unit(k % 3); };
      AddRectangle(points, side * edge(axis), edge(axis + 1), edge(axis + 2));
    }
}

void AddEllipsoid(Points& points, const Eigen::Vector3d& size, double stretch_z_m = 0.0) {
  const int n = Steps(std::numbers::pi * size.maxCoeff());
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k < 2 * n; ++k) {
      const double polar = std::numbers::pi * i / n, azimuth = std::numbers::pi * k / n;
      const Eigen::Vector3d unit(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                 std::cos(polar));
      points.push_back(unit.cwiseProduct(size) + std::copysign(stretch_z_m, unit.z()) * Eigen::Vector3d::UnitZ());
    }
}

void AddTube(Points& points, double radius_m, double half_m, bool caps) {
  const int around = 2 * Steps(std::numbers::pi * radius_m), along = Steps(2 * half_m),
            out = caps ? Steps(radius_m) : 0;
  for (int k = 0; k < around; ++k) {
    const double angle = 2 * std::numbers::pi * k / around;
    const Eigen::Vector3d rim = radius_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    for (int i = 0; i <= along; ++i) points.push_back(rim + (2.0 * i / along - 1) * half_m * Eigen::Vector3d::UnitZ());
    for (int i = 0; i < out; ++i)
      for (const double side : {-half_m, half_m}) points.push_back(rim * i / out + side * Eigen::Vector3d::UnitZ());
  }
}

void AddMesh(Points& points, const TriangleMesh& mesh) {
  for (const std::array<int, 3>& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]], u = mesh.vertices[t[1]] - a, v = mesh.vertices[t[2]] - a;
    const int n = Steps(std::max({u.norm(), v.norm(), (u - v).norm()}));
    for (int i = 0; i <= n; ++i)
      for (int k = 0; k <= n - i; ++k) points.push_back(a + u * i / n + v * k / n);
  }
}

Points PointsInFrame(const mjModel* model, int geom) {
  const Eigen::Vector3d size = Eigen::Vector3d::Map(model->geom_size + 3 * geom);
  Points points;
  switch (model->geom_type[geom]) {
    case mjGEOM_PLANE: {
      const auto half = [&](int axis) { return size[axis] > 0.0 ? size[axis] : kSampledPlane_m; };
      AddRectangle(points, {0, 0, 0}, half(0) * Eigen::Vector3d::UnitX(), half(1) * Eigen::Vector3d::UnitY());
      break;
    }
    case mjGEOM_BOX:
      AddBox(points, size);
      break;
    case mjGEOM_SPHERE:
      AddEllipsoid(points, {size[0], size[0], size[0]});
      break;
    case mjGEOM_ELLIPSOID:
      AddEllipsoid(points, size);
      break;
    case mjGEOM_CAPSULE:
      AddEllipsoid(points, {size[0], size[0], size[0]}, size[1]);
      AddTube(points, size[0], size[1], false);
      break;
    case mjGEOM_CYLINDER:
      AddTube(points, size[0], size[1], true);
      break;
    case mjGEOM_MESH:
      AddMesh(points, MeshOf(model, geom));
      break;
    default:
      break;
  }
  return points;
}

// The point of a triangle nearest to p (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
Eigen::Vector3d Nearest(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  if (d3 >= 0.0 && d4 <= d3) return b;
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

// Solid angle of a triangle seen from p (Van Oosterom, Strackee, IEEE Trans. Biomedical Engineering 30(2), 1983).
double SolidAngle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c) {
  const Eigen::Vector3d u = a - p, v = b - p, w = c - p;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  return 2 * std::atan2(u.dot(v.cross(w)), lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv);
}

}  // namespace

TriangleMesh MeshOf(const mjModel* model, int geom) {
  const int id = model->geom_dataid[geom];
  TriangleMesh mesh;
  for (int i = 0; i < model->mesh_vertnum[id]; ++i)
    mesh.vertices.push_back(Eigen::Vector3f::Map(model->mesh_vert + 3 * (model->mesh_vertadr[id] + i)).cast<double>());
  for (int i = 0; i < model->mesh_facenum[id]; ++i) {
    const int* corners = model->mesh_face + 3 * (model->mesh_faceadr[id] + i);
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  return mesh;
}

bool IsSeen(const mjModel* model, int geom) {
  const int material = model->geom_matid[geom];
  const float alpha = material < 0 ? model->geom_rgba[4 * geom + 3] : model->mat_rgba[4 * material + 3];
  return model->geom_group[geom] >= 0 && model->geom_group[geom] <= 2 && alpha > 0.0f;
}

bool IsFloor(const mjModel* model, int geom) {
  const char* name = mj_id2name(model, mjOBJ_GEOM, geom);
  return name != nullptr && std::string_view(name).starts_with("floor");
}

bool IsPanel(const mjModel* model, const mjData* data, int geom) {
  if (model->geom_type[geom] != mjGEOM_PLANE) return false;
  const mjtNum* size = model->geom_size + 3 * geom;
  const bool collides = model->geom_contype[geom] != 0 || model->geom_conaffinity[geom] != 0;
  return size[0] > 0.0 && size[1] > 0.0 && !IsFloor(model, geom) &&
         (!collides || data->geom_xmat[9 * geom + 8] < kFacesUp);
}

std::vector<Eigen::Vector3d> PointsOn(const mjModel* model, const mjData* data, int geom) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data->geom_xmat + 9 * geom);
  const Eigen::Vector3d position = Eigen::Vector3d::Map(data->geom_xpos + 3 * geom);
  Points points = PointsInFrame(model, geom);
  for (Eigen::Vector3d& point : points) point = R * point + position;
  return points;
}

Solid::Solid(const mjModel* model, const mjData* data, int geom)
    : geom_(geom),
      type_(model->geom_type[geom]),
      panel_(IsPanel(model, data, geom)),
      position_(Eigen::Vector3d::Map(data->geom_xpos + 3 * geom)),
      size_(Eigen::Vector3d::Map(model->geom_size + 3 * geom)),
      R_world_geom_(Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Map(data->geom_xmat + 9 * geom)),
      reach_m_(model->geom_rbound[geom]) {
  if (type_ == mjGEOM_MESH) mesh_ = MeshOf(model, geom);
}

double Solid::ToMesh_m(const Eigen::Vector3d& p, double max_m) const {
  double nearest_m = std::numeric_limits<double>::infinity(), angle = 0.0;
  for (const std::array<int, 3>& t : mesh_.triangles) {
    const Eigen::Vector3d &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
    nearest_m = std::min(nearest_m, (Nearest(p, a, b, c) - p).norm());
    if (nearest_m <= max_m) return nearest_m;
    angle += SolidAngle(p, a, b, c);
  }
  return std::abs(angle) > 2 * std::numbers::pi ? 0.0 : nearest_m;  // 4 pi inside, 0 outside
}

double Solid::Distance_m(const Eigen::Vector3d& point_world, double max_m) const {
  const Eigen::Vector3d offset = point_world - position_;
  if (reach_m_ > 0.0 && offset.norm() > reach_m_ + max_m) return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d p = R_world_geom_.transpose() * offset;
  switch (type_) {
    case mjGEOM_PLANE: {
      if (!panel_) return std::max(0.0, p.z());
      const Eigen::Vector3d from_slab = p + 0.5 * kSlab_m * Eigen::Vector3d::UnitZ();
      return (from_slab.cwiseAbs() - Eigen::Vector3d(size_.x(), size_.y(), 0.5 * kSlab_m)).cwiseMax(0.0).norm();
    }
    case mjGEOM_BOX:
      return (p.cwiseAbs() - size_).cwiseMax(0.0).norm();
    case mjGEOM_SPHERE:
      return std::max(0.0, p.norm() - size_[0]);
    case mjGEOM_CAPSULE:
      return std::max(0.0, std::hypot(p.x(), p.y(), std::max(0.0, std::abs(p.z()) - size_[1])) - size_[0]);
    case mjGEOM_CYLINDER:
      return std::hypot(std::max(0.0, std::hypot(p.x(), p.y()) - size_[0]), std::max(0.0, std::abs(p.z()) - size_[1]));
    case mjGEOM_ELLIPSOID: {
      const double k = p.cwiseQuotient(size_).norm(), slope = p.cwiseQuotient(size_.cwiseProduct(size_)).norm();
      return k <= 1.0 ? 0.0 : k * (k - 1.0) / slope;
    }
    case mjGEOM_MESH:
      return ToMesh_m(p, max_m);
    default:
      return std::numeric_limits<double>::infinity();
  }
}

}  // namespace merlin::sim
