#include "robot/kinematics/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/limits.h"

namespace merlin {
namespace {

constexpr double kArcStep_m = 0.05;

}  // namespace

double Path_m(const CarDescription& car, std::int64_t encoder_counts, double wheels_rad) {
  return car.MetresPerCount() * static_cast<double>(encoder_counts) / WheelMeanRatio(car, wheels_rad);
}

double ShaftSpeed_rad_s(const Drivetrain& drivetrain, std::int64_t encoder_counts, double period_s) {
  return 2.0 * std::numbers::pi * static_cast<double>(encoder_counts) /
         (std::max(drivetrain.encoder_counts_per_motor_turn, 1) * period_s);
}

double Turn_rad(const CarDescription& car, double path_m, double wheels_rad) {
  return path_m * std::tan(wheels_rad) / car.wheelbase_m;
}

ArcShape ShapeOfArc(double turn_rad) {
  const double a = turn_rad;
  // sin(a)/a and (1 - cos(a))/a; near zero by their series.
  if (std::abs(a) < 1e-3) return {1.0 - a * a / 6.0, 0.5 * a};
  const double s = std::sin(a), c = std::cos(a);
  return {s / a, (1.0 - c) / a};
}

Pose ArcMotion(double path_m, double turn_rad) {
  const ArcShape shape = ShapeOfArc(turn_rad);
  return FromXyYaw(path_m * shape.along, path_m * shape.across, turn_rad);
}

std::vector<Eigen::Vector2d> ArcAhead(const CarDescription& car, double wheels_rad, double length_m) {
  const double step_m = std::copysign(kArcStep_m, length_m);
  const Pose step = FromXyYaw(step_m, 0.0, Turn_rad(car, step_m, ClampSteering_rad(car, wheels_rad)));
  std::vector<Eigen::Vector2d> path_base;
  Pose T_base_ahead = Pose::Identity();
  for (double s = 0.0; s <= std::abs(length_m); s += kArcStep_m) {
    path_base.push_back(T_base_ahead.translation().head<2>());
    T_base_ahead = T_base_ahead * step;
  }
  return path_base;
}

}  // namespace merlin
