#include "sim/world/room_box.h"

namespace merlin::sim {
namespace {

using Box = Eigen::AlignedBox3d;

// In the geom's frame; empty for an infinite plane.
Box LocalBox_m(const mjModel* model, int geom) {
  const Eigen::Vector3d size = Eigen::Vector3d::Map(model->geom_size + 3 * geom);
  if (model->geom_type[geom] == mjGEOM_PLANE) {
    if (size.x() <= 0.0 || size.y() <= 0.0) return Box();
    return Box(Eigen::Vector3d(-size.x(), -size.y(), 0.0), Eigen::Vector3d(size.x(), size.y(), 0.0));
  }
  const Eigen::Vector3d middle = Eigen::Vector3d::Map(model->geom_aabb + 6 * geom);
  const Eigen::Vector3d half = Eigen::Vector3d::Map(model->geom_aabb + 6 * geom + 3);
  return Box(middle - half, middle + half);
}

Pose T_world_geom(const mjData* data, int geom) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d::Map(data->geom_xpos + 3 * geom);
  pose.linear() = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Map(data->geom_xmat + 9 * geom);
  return pose;
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Even-odd rule: a point is inside if a ray from it to the right crosses the outline an odd number of times.
bool Holds(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

}  // namespace

std::optional<Eigen::AlignedBox2d> RoomBox_m(const World& world) {
  const mjModel* model = world.model();
  Eigen::AlignedBox2d room;
  for (int geom = 0; geom < model->ngeom; ++geom) {
    const bool is_actor = model->body_mocapid[model->geom_bodyid[geom]] >= 0;
    if (world.IsCarGeom(geom) || is_actor) continue;
    const Box box = LocalBox_m(model, geom);
    if (box.isEmpty()) continue;
    for (int corner = 0; corner < 8; ++corner)
      room.extend(
          (T_world_geom(world.data(), geom) * box.corner(static_cast<Box::CornerType>(corner))).head<2>().eval());
  }
  if (!room.contains(world.T_world_base().translation().head<2>().eval())) return std::nullopt;
  return room;
}

std::vector<Eigen::Vector2d> RoomOutline_m(const World& world) {
  if (!world.plan_xy_m().empty()) return world.plan_xy_m();
  const auto box = RoomBox_m(world);
  if (!box) return {};
  return {box->min(), {box->max().x(), box->min().y()}, box->max(), {box->min().x(), box->max().y()}};
}

bool HoldsLine(const std::vector<Eigen::Vector2d>& outline_m, const Eigen::Vector2d& from_m,
               const Eigen::Vector2d& to_m) {
  if (!Holds(outline_m, from_m) || !Holds(outline_m, to_m)) return false;
  const Eigen::Vector2d along = to_m - from_m;
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d &a = outline_m[i], &b = outline_m[(i + 1) % outline_m.size()];
    const bool parts_wall = Cross(along, a - from_m) * Cross(along, b - from_m) < 0.0;
    const bool parts_line = Cross(b - a, from_m - a) * Cross(b - a, to_m - a) < 0.0;
    if (parts_wall && parts_line) return false;
  }
  return true;
}

}  // namespace merlin::sim
