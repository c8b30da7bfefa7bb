#include "sim/world/true_car.h"

#include <algorithm>

namespace merlin::sim {
namespace {

// Rotation from a link's frame to the base's with all joints at 0.
Eigen::Matrix3d R_base_link(const CarDescription& car, const std::string& name) {
  const auto link = std::ranges::find(car.links, name, &CarLink::name);
  if (link == car.links.end() || link->parent.empty()) return Eigen::Matrix3d::Identity();
  return R_base_link(car, link->parent) * link->T_parent_link.linear();
}

}  // namespace

CarDescription TrueCar(CarDescription car, const DrivetrainConfig& config) {
  const double forward_m = (config.wheelbase_factor - 1.0) * car.wheelbase_m;
  for (const std::size_t knuckle : car.knuckles) {
    CarLink& link = car.links[knuckle];
    link.T_parent_link.translation() += R_base_link(car, link.parent).transpose() * Eigen::Vector3d(forward_m, 0, 0);
  }
  car.wheelbase_m += forward_m;
  car.wheel_radius_m *= config.wheel_radius_factor;
  return car;
}

}  // namespace merlin::sim
