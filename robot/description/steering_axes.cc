#include "robot/description/steering_axes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "robot/base/error.h"
#include "robot/description/tyres.h"

namespace merlin {
namespace {

// In wheelbases: how far a wheel's middle may be before or behind its steering axis.
constexpr double kTrailMax = 0.02;
constexpr std::array kSides = {+1.0, -1.0};  // left, right

// The inverse of Ackermann's law: the angle of the virtual middle wheel at which the wheel of that side has this angle.
double MiddleAngle_rad(const CarDescription& car, double wheel_rad, double side) {
  const double tangent = std::tan(wheel_rad);
  return std::atan2(tangent, 1.0 + 0.5 * side * car.steering_track_m / car.wheelbase_m * tangent);
}

// Reverses the sign of the joint's angle.
void TurnRound(CarLink& link) {
  link.axis = -link.axis;
  std::swap(link.joint_min_rad, link.joint_max_rad);
  link.joint_min_rad = -link.joint_min_rad, link.joint_max_rad = -link.joint_max_rad;
}

}  // namespace

void LimitKnuckle(const UrdfSource& source, const CarMapping& mapping, CarLink& link) {
  if (link.joint == CarLink::Joint::kContinuous) {
    if (!mapping.steering_limit_rad)
      throw InputError(source.Where(link.joint_name), fmt::format("joint '{}' must steer", link.joint_name),
                       fmt::format("type revolute, with limits, or steering_limit_rad in {}",
                                   MappingFile(source.path).filename().string()));
    link.joint = CarLink::Joint::kRevolute;
    link.joint_min_rad = -HUGE_VAL, link.joint_max_rad = HUGE_VAL;
  }
  if (!mapping.steering_limit_rad) return;
  link.joint_min_rad = std::max(link.joint_min_rad, -*mapping.steering_limit_rad);
  link.joint_max_rad = std::min(link.joint_max_rad, *mapping.steering_limit_rad);
}

void DeriveSteering(const UrdfSource& source, LinkTree& tree, const Pose& T_base_root, CarDescription& car,
                    Asymmetry& asymmetry) {
  std::array<Eigen::Vector3d, 2> pivots;
  for (std::size_t i = 0; i < 2; ++i) {
    CarLink& link = tree.Link(car.knuckles[i]);
    const Eigen::Vector3d axis = T_base_root.linear() * tree.AxisInRoot(car.knuckles[i]);
    if (std::abs(axis.z()) < kParallel)
      throw InputError(source.Where(link.joint_name), fmt::format("joint '{}': axis", link.joint_name),
                       "an upright one");
    if (axis.z() < 0.0) TurnRound(link);
    const Eigen::Vector3d joint = T_base_root * tree.T_root(car.knuckles[i]).translation();
    pivots[i] = joint + axis * (car.wheel_radius_m - joint.z()) / axis.z();
  }
  const CarLink& left = tree.Link(car.knuckles[0]);
  const double pivot_m = 0.5 * (pivots[0].x() + pivots[1].x());
  if (!(std::abs(pivot_m - car.wheelbase_m) <= kTrailMax * car.wheelbase_m))
    throw InputError(source.Where(left.joint_name), fmt::format("joint '{}': its axis", left.joint_name),
                     fmt::format("at x {:.6g} m as the wheel's middle", car.wheelbase_m),
                     fmt::format("{:.6g} m", pivot_m));
  car.steering_track_m = pivots[0].y() - pivots[1].y();
  const double off_m = OffSymmetry_m(pivots[0], pivots[1]);
  asymmetry.Add("the steering axes", off_m);
  if (!(car.steering_track_m > 0.0) || IsLopsided(off_m))
    throw InputError(source.Where(left.joint_name),
                     fmt::format("joints '{}' and '{}': the two steering axes", left.joint_name,
                                 tree.Link(car.knuckles[1]).joint_name),
                     "one on each side, " + MostOffText(),
                     fmt::format("{} and {}", PointText(pivots[0]), PointText(pivots[1])));
  car.steering_max_rad = HUGE_VAL;
  for (std::size_t i = 0; i < 2; ++i) {
    const CarLink& link = tree.Link(car.knuckles[i]);
    if (!(link.joint_min_rad < 0.0 && link.joint_max_rad > 0.0 &&
          std::max(-link.joint_min_rad, link.joint_max_rad) < 1.5))
      throw InputError(source.Where(link.joint_name), fmt::format("joint '{}': steering limits", link.joint_name),
                       "both sides of 0, below 1.5 rad",
                       fmt::format("{} and {} rad", link.joint_min_rad, link.joint_max_rad));
    for (const double limit_rad : {link.joint_min_rad, link.joint_max_rad})
      car.steering_max_rad = std::min(car.steering_max_rad, std::abs(MiddleAngle_rad(car, limit_rad, kSides[i])));
  }
}

void DerivePan(const UrdfSource& source, const CarMapping& mapping, LinkTree& tree, const Pose& T_base_root,
               CarDescription& car) {
  const bool named = !mapping.pan_joint.where.empty();
  if (!named && std::ranges::find(car.links, mapping.pan_joint.name, &CarLink::joint_name) == car.links.end()) return;
  const std::size_t index = tree.LinkBehind(mapping.pan_joint);
  CarLink& link = tree.Link(index);
  const std::string where = source.Where(link.joint_name), what = fmt::format("joint '{}'", link.joint_name);
  if (link.joint != CarLink::Joint::kRevolute) throw InputError(where, what + " turns the cameras", "type revolute");
  const Eigen::Vector3d axis = T_base_root.linear() * tree.AxisInRoot(index);
  if (std::abs(axis.z()) < kParallel) throw InputError(where, what + ": axis", "an upright one");
  if (axis.z() < 0.0) TurnRound(link);
  if (!(link.joint_min_rad <= 0.0 && link.joint_max_rad >= 0.0 && link.joint_speed_max_rad_s > 0.0))
    throw InputError(where, what + ": limits", "lower <= 0 <= upper, and a velocity above 0");
  for (const RoleName& camera : {mapping.depth_camera, mapping.color_camera})
    if (tree.Has(camera) && !tree.IsBelow(tree.LinkOf(camera), index))
      throw InputError(where, what + " turns the cameras", fmt::format("'{}' below it", camera.name));
  const Eigen::Vector3d pivot = T_base_root * tree.T_root(index).translation();
  car.pan = CarPan{.link = index,
                   .T_base_pan = AtAxle(pivot, axis.z() < 0.0 ? Eigen::Vector3d(-axis) : axis),
                   .slew_rad_s = link.joint_speed_max_rad_s};
}

}  // namespace merlin
