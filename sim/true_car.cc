#include "sim/true_car.h"

#include <algorithm>

#include "sim/car_body.h"

namespace merlin::sim {
namespace {

// What carries a steered wheel: a link on a joint of limited angle.
bool IsKnuckle(const CarDescription& car, const CarLink& link) {
  return link.joint == CarLink::Joint::kRevolute && std::ranges::any_of(car.links, [&](const CarLink& wheel) {
           return car_body::IsWheel(wheel) && wheel.parent == link.name;
         });
}

}  // namespace

CarDescription TrueCar(CarDescription car, const DrivetrainConfig& config) {
  const double forward_m = (config.wheelbase_factor - 1.0) * car.wheelbase_m;
  for (CarLink& link : car.links) {
    if (IsKnuckle(car, link)) link.T_parent_link.translation().x() += forward_m;
    if (!car_body::IsWheel(link)) continue;
    for (CarShape& tyre : link.collision) tyre.size_m.x() *= config.wheel_radius_factor;
  }
  car.wheelbase_m += forward_m;
  car.wheel_radius_m *= config.wheel_radius_factor;
  return car;
}

}  // namespace merlin::sim
