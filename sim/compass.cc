#include "sim/compass.h"

#include <cmath>
#include <numbers>

#include "robot/base/random.h"

namespace merlin::sim {
namespace {

double WrapHalfOpen(double angle_rad) {  // (-pi, pi]
  const double wrapped = WrapPi(angle_rad);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

}  // namespace

double BendAt(const std::vector<Steel>& steel, double x_m, double y_m) {
  double bend_rad = 0.0;
  for (const Steel& one : steel)
    bend_rad += one.bend_rad * std::exp(-0.5 * std::pow(std::hypot(x_m - one.x_m, y_m - one.y_m) / one.reach_m, 2));
  return bend_rad;
}

CompassReading ReadCompass(const Pose& T_world_base, const CompassConfig& config, std::uint64_t seed, Time stamp,
                           std::uint64_t index) {
  // R = Rz(yaw) Ry(pitch) Rx(roll), solved for the angles (Craig, "Introduction to robotics", eq. 2.66).
  const Eigen::Matrix3d R = T_world_base.linear();
  Random random(seed, Sensor::kCompass, index);
  const double roll_rad = std::atan2(R(2, 1), R(2, 2));
  const double pitch_rad = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  const double yaw_rad = std::atan2(R(1, 0), R(0, 0)) +
                         BendAt(config.steel, T_world_base.translation().x(), T_world_base.translation().y());
  return {.stamp = stamp,
          .roll_rad = WrapHalfOpen(roll_rad + config.tilt_noise_rad * random.Normal()),
          .pitch_rad = WrapHalfOpen(pitch_rad + config.tilt_noise_rad * random.Normal()),
          .yaw_rad = WrapHalfOpen(yaw_rad + config.yaw_noise_rad * random.Normal())};
}

}  // namespace merlin::sim
