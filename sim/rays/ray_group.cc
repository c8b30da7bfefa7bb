#include "sim/rays/ray_group.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "robot/base/error.h"

namespace merlin::sim {
namespace {

constexpr mjtNum kInfinitePlane_m = 1000.0;  // half edge of a plane of infinite size (0 in MJCF)

bool IsStatic(const mjModel* model, int body) { return model->body_weldid[body] == 0; }

// As in mj_ray: if a geom has a material, the material's alpha counts and not the geom's.
bool IsVisible(const mjModel* model, int geom) {
  const int material = model->geom_matid[geom];
  const float alpha = material < 0 ? model->geom_rgba[4 * geom + 3] : model->mat_rgba[4 * material + 3];
  return model->geom_group[geom] >= 0 && model->geom_group[geom] <= 2 && alpha > 0.0f;
}

RayFace FaceThrough(const RayGroup& group, int geom, unsigned a, unsigned b, unsigned c) {
  const Eigen::Vector3d p = group.vertices[a].cast<double>();
  const Eigen::Vector3d normal =
      (group.vertices[b].cast<double>() - p).cross(group.vertices[c].cast<double>() - p).normalized();
  return {geom, normal, normal.dot(p)};
}

void AddQuad(RayGroup& group, int geom, unsigned a, unsigned b, unsigned c, unsigned d) {
  group.triangles.push_back({a, b, c});
  group.triangles.push_back({a, c, d});
  group.face_of_triangle.insert(group.face_of_triangle.end(), 2, static_cast<int>(group.faces.size()));
  group.faces.push_back(FaceThrough(group, geom, a, b, c));
}

void AddPlane(RayGroup& group, int geom, const mjtNum* size, const Pose& T_group_geom) {
  const double x = size[0] > 0.0 ? size[0] : kInfinitePlane_m, y = size[1] > 0.0 ? size[1] : kInfinitePlane_m;
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(-x, -y, 0), {x, -y, 0}, {x, y, 0}, {-x, y, 0}})
    group.vertices.push_back((T_group_geom * corner).cast<float>());
  group.one_sided = true;
  AddQuad(group, geom, 0, 1, 2, 3);
}

void AddBox(RayGroup& group, int geom, const mjtNum* size, const Pose& T_group_geom) {
  const unsigned first = static_cast<unsigned>(group.vertices.size());
  for (unsigned corner = 0; corner < 8; ++corner) {  // bit i of the corner selects the positive side of axis i
    const Eigen::Vector3d sign((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
    group.vertices.push_back((T_group_geom * sign.cwiseProduct(Eigen::Vector3d(size))).cast<float>());
  }
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned u = 1u << ((axis + 1) % 3), v = 1u << ((axis + 2) % 3);
    for (const unsigned side : {0u, 1u << axis}) {
      AddQuad(group, geom, first + side, first + side + u, first + side + u + v, first + side + v);
    }
  }
}

void AddMesh(RayGroup& group, const mjModel* model, int geom, const Pose& T_group_geom) {
  const int mesh = model->geom_dataid[geom];
  const unsigned first = static_cast<unsigned>(group.vertices.size());
  for (int i = 0; i < model->mesh_vertnum[mesh]; ++i) {
    const Eigen::Map<const Eigen::Vector3f> vertex(model->mesh_vert + 3 * (model->mesh_vertadr[mesh] + i));
    group.vertices.push_back((T_group_geom * vertex.cast<double>()).cast<float>());
  }
  // One face holds normals within 1e-5 and offsets within 0.1 mm. Faces split by rounding only cost time.
  std::map<std::array<long, 4>, int> known;
  for (int i = 0; i < model->mesh_facenum[mesh]; ++i) {
    const int* corners = model->mesh_face + 3 * (model->mesh_faceadr[mesh] + i);
    const auto vertex = [&](int corner) { return first + static_cast<unsigned>(corners[corner]); };
    group.triangles.push_back({vertex(0), vertex(1), vertex(2)});
    const RayFace face = FaceThrough(group, geom, vertex(0), vertex(1), vertex(2));
    const Eigen::Vector3d rounded = 1e5 * face.normal;
    const auto [found, is_new] = known.try_emplace({std::lround(rounded.x()), std::lround(rounded.y()),
                                                    std::lround(rounded.z()), std::lround(1e4 * face.offset_m)},
                                                   static_cast<int>(group.faces.size()));
    if (is_new) group.faces.push_back(face);
    group.face_of_triangle.push_back(found->second);
  }
}

void AddCurved(RayGroup& group, const mjModel* model, int geom, const Pose& T_group_geom) {
  CurvedGeom curved{.geom = geom, .type = model->geom_type[geom], .position = {}, .rotation = {}, .size = {}};
  Eigen::Map<Eigen::Vector3d>(curved.position) = T_group_geom.translation();
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(curved.rotation) = T_group_geom.linear();
  std::copy_n(model->geom_size + 3 * geom, 3, curved.size);
  group.curved.push_back(curved);
}

void AddGeom(RayGroup& group, const mjModel* model, int geom, const Pose& T_group_geom) {
  const mjtNum* size = model->geom_size + 3 * geom;
  switch (model->geom_type[geom]) {
    case mjGEOM_PLANE:
      return AddPlane(group, geom, size, T_group_geom);
    case mjGEOM_BOX:
      return AddBox(group, geom, size, T_group_geom);
    case mjGEOM_MESH:
      return AddMesh(group, model, geom, T_group_geom);
    case mjGEOM_SPHERE:
    case mjGEOM_CAPSULE:
    case mjGEOM_CYLINDER:
    case mjGEOM_ELLIPSOID:
      return AddCurved(group, model, geom, T_group_geom);
    default:
      const char* name = mj_id2name(model, mjOBJ_GEOM, geom);
      throw InputError(
          fmt::format("geom '{}'", name ? name : std::to_string(geom)), "the depth camera cannot see this type of geom",
          "plane, sphere, capsule, ellipsoid, cylinder, box or mesh", "a height field or signed distance field");
  }
}

}  // namespace

Pose ToPose(const mjtNum* position, const mjtNum* quaternion_wxyz) {
  const Eigen::Quaterniond q(quaternion_wxyz[0], quaternion_wxyz[1], quaternion_wxyz[2], quaternion_wxyz[3]);
  return Eigen::Translation3d(position[0], position[1], position[2]) * q.normalized();
}

std::vector<Pose> ReferencePoses(const mjModel* model) {
  std::vector<Pose> poses;
  for (int b = 0; b < model->nbody; ++b) {
    const Pose T_parent_body = ToPose(model->body_pos + 3 * b, model->body_quat + 4 * b);
    const auto parent = static_cast<std::size_t>(model->body_parentid[b]);
    poses.push_back(b == 0 ? Pose::Identity() : Pose(poses[parent] * T_parent_body));
  }
  return poses;
}

Eigen::Vector3d HalfEdges(const CurvedGeom& curved) {
  const mjtNum* s = curved.size;
  switch (curved.type) {
    case mjGEOM_SPHERE:
      return {s[0], s[0], s[0]};
    case mjGEOM_CAPSULE:
      return {s[0], s[0], s[0] + s[1]};
    case mjGEOM_CYLINDER:
      return {s[0], s[0], s[1]};
    default:  // ellipsoid
      return {s[0], s[1], s[2]};
  }
}

RayGroup::Sphere RayGroup::Around() const {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : vertices) box.extend(vertex.cast<double>().eval());
  for (const CurvedGeom& of : curved) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(of.rotation);
    const Eigen::Vector3d middle = Eigen::Vector3d::Map(of.position), half = R.cwiseAbs() * HalfEdges(of);
    box.extend((middle - half).eval());
    box.extend((middle + half).eval());
  }
  if (box.isEmpty()) return {};
  return {box.center(), 0.5 * box.diagonal().norm()};
}

std::deque<RayGroup> GroupGeoms(const mjModel* model, const std::vector<bool>& skip_body,
                                const std::vector<bool>& is_pane) {
  const std::vector<Pose> reference = ReferencePoses(model);
  std::deque<RayGroup> groups;
  std::map<std::pair<int, bool>, RayGroup*> group_of;  // body (0: all statics), panes or not
  for (int geom = 0; geom < model->ngeom; ++geom) {
    const int geom_body = model->geom_bodyid[geom];
    if (skip_body[static_cast<std::size_t>(geom_body)] || !IsVisible(model, geom)) continue;
    const int body = IsStatic(model, geom_body) ? 0 : geom_body;
    const bool pane = !is_pane.empty() && is_pane[static_cast<std::size_t>(geom)];
    Pose T_body_geom = ToPose(model->geom_pos + 3 * geom, model->geom_quat + 4 * geom);
    if (body == 0) T_body_geom = reference[static_cast<std::size_t>(geom_body)] * T_body_geom;

    const bool plane = model->geom_type[geom] == mjGEOM_PLANE;
    RayGroup*& of_body = group_of[{body, pane}];
    if (plane || of_body == nullptr) {
      RayGroup& made = groups.emplace_back();
      made.body = body;
      made.panes = pane;
      made.fixed = body == 0 && (!plane || T_body_geom.linear().row(2).isApprox(Eigen::RowVector3d::UnitZ(), 0.0));
      if (!plane) of_body = &made;
    }
    RayGroup& group = plane ? groups.back() : *of_body;
    const bool own_frame = plane && !group.fixed;
    if (own_frame) group.T_body_group = T_body_geom;
    AddGeom(group, model, geom, own_frame ? Pose::Identity() : T_body_geom);
  }
  return groups;
}

}  // namespace merlin::sim
