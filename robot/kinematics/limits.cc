#include "robot/kinematics/limits.h"

#include <algorithm>
#include <cmath>

namespace merlin {

double ClampSteering_rad(const CarDescription& car, double wheels_rad) {
  return std::clamp(wheels_rad, -car.steering_max_rad, car.steering_max_rad);
}

DriveCommand ClampCommand(const CarDescription& car, const DriveCommand& command) {
  DriveCommand clamped = command;
  clamped.speed_m_s = std::clamp(command.speed_m_s, -car.drivetrain.speed_max_m_s, car.drivetrain.speed_max_m_s);
  clamped.steering_rad = ClampSteering_rad(car, command.steering_rad);
  return clamped;
}

double SpeedToStopWithin_m_s(double distance_m, double deceleration_m_s2) {
  return std::sqrt(2.0 * deceleration_m_s2 * std::max(0.0, distance_m));
}

}  // namespace merlin
