#include "robot/description/tyres.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "robot/base/error.h"

namespace merlin {
namespace {

// A wheel's tyre: where its middle is, and how large.
struct Tyre {
  Pose T_link_tyre = Pose::Identity();
  double radius_m = 0.0, width_m = 0.0;
};

// The size of a mesh about the axle: its farthest vertex, and its middle along the axle.
Tyre MeshTyre(const CarShape& shape, const Eigen::Vector3d& axis) {
  double radius_m = 0.0, nearest_m = HUGE_VAL, farthest_m = -HUGE_VAL;
  for (const Eigen::Vector3f& vertex : shape.mesh->vertices) {
    const Eigen::Vector3d point = shape.T_link_shape * shape.size_m.cwiseProduct(vertex.cast<double>());
    const double along_m = axis.dot(point);
    radius_m = std::max(radius_m, (point - along_m * axis).norm());
    nearest_m = std::min(nearest_m, along_m), farthest_m = std::max(farthest_m, along_m);
  }
  return {AtAxle(0.5 * (nearest_m + farthest_m) * axis, axis), radius_m, farthest_m - nearest_m};
}

// The tyre as the largest round shape gives it. A cylinder must lie along the axle. A sphere is round about every axis,
// and a mesh is assumed to be round.
std::optional<Tyre> RoundTyre(const std::vector<CarShape>& shapes, const Eigen::Vector3d& axis) {
  std::optional<Tyre> largest;
  for (const CarShape& shape : shapes) {
    Tyre tyre{shape.T_link_shape, shape.size_m.x(), shape.size_m.y()};
    if (shape.kind == CarShape::Kind::kBox) continue;
    if (shape.kind == CarShape::Kind::kCylinder && std::abs(shape.T_link_shape.linear().col(2).dot(axis)) < kParallel)
      continue;
    if (shape.kind == CarShape::Kind::kSphere)
      tyre = {AtAxle(shape.T_link_shape.translation(), axis), shape.size_m.x(), 2.0 * shape.size_m.x()};
    if (shape.kind == CarShape::Kind::kMesh) tyre = MeshTyre(shape, axis);
    if (!largest || tyre.radius_m > largest->radius_m) largest = tyre;
  }
  return largest;
}

// From the collision shapes, or from the visual ones if no collision shape is round. Values of the mapping override
// both.
Tyre FindTyre(const UrdfSource& source, const CarMapping& mapping, const CarLink& link) {
  std::optional<Tyre> tyre = RoundTyre(link.collision, link.axis);
  if (!tyre) tyre = RoundTyre(link.visual, link.axis);
  if (!tyre && mapping.wheel_radius_m && mapping.wheel_width_m) tyre = {AtAxle({0, 0, 0}, link.axis), 0.0, 0.0};
  if (!tyre)
    throw InputError(
        source.Where(link.name), fmt::format("'{}': how large the tyre is", link.name),
        fmt::format("a cylinder about the axle, a sphere or a mesh, or wheel_radius_m and wheel_width_m in {}",
                    MappingFile(source.path).filename().string()));
  if (mapping.wheel_radius_m) tyre->radius_m = *mapping.wheel_radius_m;
  if (mapping.wheel_width_m) tyre->width_m = *mapping.wheel_width_m;
  return *tyre;
}

}  // namespace

Pose AtAxle(const Eigen::Vector3d& middle, const Eigen::Vector3d& axis) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
  pose.translation() = middle;
  return pose;
}

Middles DeriveTyres(const UrdfSource& source, const CarMapping& mapping, LinkTree& tree, CarDescription& car) {
  Middles middles;
  for (std::size_t i = 0; i < 4; ++i) {
    CarWheel& wheel = car.wheels[i];
    const CarLink& link = tree.Link(wheel.link);
    const Tyre tyre = FindTyre(source, mapping, link);
    wheel.T_link_tyre = tyre.T_link_tyre, wheel.width_m = tyre.width_m;
    if (i == 0) car.wheel_radius_m = tyre.radius_m;
    if (!(std::abs(tyre.radius_m - car.wheel_radius_m) <= kSameLength_m))
      throw InputError(source.Where(link.name), fmt::format("'{}': radius of the tyre", link.name),
                       fmt::format("{:.6g} m as of '{}'", car.wheel_radius_m, tree.Link(car.wheels[0].link).name),
                       fmt::format("{:.6g} m", tyre.radius_m));
    const Eigen::Vector3d middle = wheel.T_link_tyre.translation();
    if ((middle - link.axis * link.axis.dot(middle)).norm() > kSameLength_m)
      throw InputError(source.Where(link.name), fmt::format("'{}': the tyre's middle", link.name),
                       "on its joint's axis", PointText(middle) + " from the joint");
    middles[i] = tree.T_root(wheel.link) * middle;
  }
  return middles;
}

}  // namespace merlin
