#include "robot/kinematics/ackermann.h"

#include <cmath>

namespace merlin {

double Curvature_1_m(const CarDescription& car, double wheels_rad) { return std::tan(wheels_rad) / car.wheelbase_m; }

double WheelsAngleForCurvature_rad(const CarDescription& car, double curvature_1_m) {
  return std::atan(car.wheelbase_m * curvature_1_m);
}

double FrontWheelAngle_rad(const CarDescription& car, double wheels_rad, Side side) {
  // The wheel stands half a steering track nearer to the centre of the circle, or farther from it.
  const double sign = side == Side::kLeft ? 1.0 : -1.0, tangent = std::tan(wheels_rad);
  return std::atan2(car.wheelbase_m * tangent, car.wheelbase_m - sign * 0.5 * car.steering_track_m * tangent);
}

double WheelMeanRatio(const CarDescription& car, double wheels_rad) {
  // In units of the radius R: half track t, wheelbase l. The mean of the two rear wheels' paths is 1.
  const double curvature_1_m = Curvature_1_m(car, std::abs(wheels_rad));
  const double t = 0.5 * car.track_m * curvature_1_m;
  const double l = car.wheelbase_m * curvature_1_m;
  return 0.5 + 0.25 * (std::hypot(1.0 - t, l) + std::hypot(1.0 + t, l));
}

double ShaftTurnPerMetre_rad_m(const CarDescription& car, double wheels_rad) {
  return car.drivetrain.gear * WheelMeanRatio(car, wheels_rad) / car.wheel_radius_m;
}

}  // namespace merlin
