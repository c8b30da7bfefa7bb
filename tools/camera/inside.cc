#include "tools/camera/inside.h"

#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "sim/rays/ray_group.h"
#include "sim/world/room.h"

namespace merlin {
namespace {

// Does the ray from the origin along this direction meet the triangle? (Moller, Trumbore, J. Graphics Tools 2(1), 1997)
bool Crosses(const Eigen::Vector3d& direction, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) {
  const Eigen::Vector3d edge_1 = b - a, edge_2 = c - a, p = direction.cross(edge_2);
  const double determinant = edge_1.dot(p);
  if (determinant == 0.0) return false;
  const double u = -a.dot(p) / determinant;
  const Eigen::Vector3d q = -a.cross(edge_1);
  const double v = direction.dot(q) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && edge_2.dot(q) / determinant > 0.0;
}

bool IsBelowPlane(const mjModel* model, const mjData* data, int geom, const Eigen::Vector3d& point_world) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data->geom_xmat + 9 * geom);
  const Eigen::Vector3d p =
      R.transpose() * (point_world - Eigen::Map<const Eigen::Vector3d>(data->geom_xpos + 3 * geom));
  const mjtNum* half = model->geom_size + 3 * geom;  // 0: endless
  return p.z() <= 0.0 && (half[0] <= 0.0 || std::abs(p.x()) <= half[0]) &&
         (half[1] <= 0.0 || std::abs(p.y()) <= half[1]);
}

}  // namespace

std::optional<std::string> GeomAround(const mjModel* model, const mjData* data, const Eigen::Vector3d& point_world) {
  const Eigen::Vector3d direction = Eigen::Vector3d(0.5377, 0.2113, 0.8163).normalized();  // along no edge
  const std::vector<bool> none(static_cast<std::size_t>(model->nbody), false);
  for (const sim::RayGroup& group : sim::GroupGeoms(model, none, {})) {
    const Pose T_group_world =
        (sim::ToPose(data->xpos + 3 * group.body, data->xquat + 4 * group.body) * group.T_body_group).inverse();
    const Eigen::Vector3d point = T_group_world * point_world;
    std::map<int, int> crossings;
    std::set<int> geoms;
    for (std::size_t i = 0; i < group.triangles.size(); ++i) {
      const int geom = group.faces[static_cast<std::size_t>(group.face_of_triangle[i])].geom;
      geoms.insert(geom);
      if (model->geom_type[geom] != mjGEOM_MESH) continue;
      const auto corner = [&](int k) -> Eigen::Vector3d {
        return group.vertices[group.triangles[i][k]].cast<double>() - point;
      };
      crossings[geom] += Crosses(direction, corner(0), corner(1), corner(2)) ? 1 : 0;
    }
    for (const sim::CurvedGeom& curved : group.curved) geoms.insert(curved.geom);
    for (const int geom : geoms) {
      const bool inside = model->geom_type[geom] == mjGEOM_MESH ? crossings[geom] % 2 == 1
                          : model->geom_type[geom] == mjGEOM_PLANE
                              ? IsBelowPlane(model, data, geom, point_world)
                              : sim::IsInside(model, data, geom, point_world.data());
      if (inside) return sim::GeomName(model, geom);
    }
  }
  return std::nullopt;
}

bool HasVisibleGeom(const mjModel* model) {
  return !sim::GroupGeoms(model, std::vector<bool>(static_cast<std::size_t>(model->nbody), false), {}).empty();
}

}  // namespace merlin
