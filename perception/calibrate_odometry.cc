#include "perception/calibrate_odometry.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/motion.h"

namespace merlin {
namespace {

// The unknowns over their described values, the offset in radians: all of the order of one.
using Unknowns = Eigen::Vector3d;

constexpr double kCircle_rad = 0.02;  // reported angles nearer to zero make no circle one can measure
constexpr int kIterations = 20;
constexpr double kSettled = 1e-10;
// A value known no better than this was not determined by the drives.
constexpr double kRadiusSigma = 0.01, kWheelbaseSigma = 0.05, kOffsetSigma_rad = 0.05;
constexpr double kRmsMax = 6.0;  // in sigmas: beyond, some drive was measured or written down wrongly

CarCalibration ValueOf(const CarDescription& described, const Unknowns& x) {
  return {.wheel_radius_m = x[0] * described.wheel_radius_m,
          .wheelbase_m = x[1] * described.wheelbase_m,
          .steering_offset_rad = x[2]};
}

// The straight line between the ends of the drive. The servo stands at zero; an offset bends the path to an arc.
double Distance_m(const CarDescription& car, const StraightDrive& drive) {
  const double wheels_rad = WheelsAngle_rad(car, 0.0);
  const double path_m = Path_m(car, drive.encoder_counts, wheels_rad);
  const double half_turn_rad = Turn_rad(car, 0.5 * path_m, wheels_rad);
  return path_m * ShapeOfArc(half_turn_rad).along;
}

double Diameter_m(const CarDescription& car, const CircleDrive& drive) {
  const double side = drive.steering_rad > 0.0 ? 1.0 : -1.0;
  return side * 2.0 / Curvature_1_m(car, WheelsAngle_rad(car, drive.steering_rad));
}

// Predicted less measured, each over its sigma.
Eigen::VectorXd Residuals(const CarDescription& described, const MeasuredDrives& drives, const Unknowns& x) {
  const CarDescription car = Calibrated(described, ValueOf(described, x));
  Eigen::VectorXd residuals(static_cast<Eigen::Index>(drives.straights.size() + drives.circles.size()));
  Eigen::Index row = 0;
  for (const StraightDrive& drive : drives.straights)
    residuals[row++] = (Distance_m(car, drive) - drive.distance_m) / drives.tape_sigma_m;
  for (const CircleDrive& drive : drives.circles) {
    const double by_angle_m = 2.0 * described.wheelbase_m / std::pow(std::sin(drive.steering_rad), 2);
    residuals[row++] = (Diameter_m(car, drive) - drive.diameter_m) /
                       std::hypot(drives.tape_sigma_m, by_angle_m * drives.steering_sigma_rad);
  }
  return residuals;
}

Eigen::MatrixXd Jacobian(const CarDescription& described, const MeasuredDrives& drives, const Unknowns& x) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd J(static_cast<Eigen::Index>(drives.straights.size() + drives.circles.size()), 3);
  for (int i = 0; i < 3; ++i) {
    const Unknowns step = kStep * Unknowns::Unit(i);
    J.col(i) = (Residuals(described, drives, x + step) - Residuals(described, drives, x - step)) / (2.0 * kStep);
  }
  return J;
}

std::string ProblemWith(const MeasuredDrives& drives) {
  if (drives.straights.empty()) return "too few drives: no straight one, which the wheel radius needs";
  bool left = false, right = false;
  for (const CircleDrive& drive : drives.circles) {
    if (std::abs(drive.steering_rad) < kCircle_rad) return "a circle is driven at a steering angle of about zero";
    (drive.steering_rad > 0.0 ? left : right) = true;
  }
  if (!left || !right)
    return "too few drives: circles to the left and to the right are needed to tell wheelbase from steering offset";
  return "";
}

std::string Undetermined(const Unknowns& sigma) {
  if (!(sigma[0] < kRadiusSigma)) return "the drives do not determine the wheel radius: drive a longer straight line";
  if (!(sigma[1] < kWheelbaseSigma)) return "the drives do not determine the wheelbase: drive more and tighter circles";
  if (!(sigma[2] < kOffsetSigma_rad)) return "the drives do not determine the steering offset: drive more circles";
  return "";
}

}  // namespace

OdometryCalibration CalibrateOdometry(const CarDescription& described, const MeasuredDrives& drives) {
  OdometryCalibration result{.problem = ProblemWith(drives), .value = {}, .sigma = {}};
  if (!result.problem.empty()) return result;
  Unknowns x(1.0, 1.0, 0.0);
  Eigen::Matrix3d information;
  bool settled = false;
  for (; !settled && result.iterations < kIterations; ++result.iterations) {
    const Eigen::MatrixXd J = Jacobian(described, drives, x);
    information = J.transpose() * J;
    const Unknowns step = information.ldlt().solve(-J.transpose() * Residuals(described, drives, x));
    x += step;
    settled = step.norm() < kSettled;
  }
  const Unknowns sigma = information.inverse().diagonal().cwiseSqrt();
  result.problem = Undetermined(sigma);
  const Eigen::VectorXd residuals = Residuals(described, drives, x);
  result.residual_rms = std::sqrt(residuals.squaredNorm() / static_cast<double>(residuals.size()));
  if (result.problem.empty() && (!settled || !(result.residual_rms < kRmsMax)))
    result.problem = "the drives contradict each other: no car drives them all; is one of the lengths wrong?";
  result.value = ValueOf(described, x);
  result.sigma = ValueOf(described, sigma);
  return result;
}

}  // namespace merlin
