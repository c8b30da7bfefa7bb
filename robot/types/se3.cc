#include "robot/types/se3.h"

#include <cmath>
#include <numbers>

namespace merlin {

double WrapPi(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

Eigen::Matrix3d Hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Matrix3d ExpSo3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d hat = Hat(w);
  const double a = angle < 1e-4 ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
  const double b = angle < 1e-4 ? 0.5 - angle * angle / 24.0 : (1.0 - std::cos(angle)) / (angle * angle);
  return Eigen::Matrix3d::Identity() + a * hat + b * hat * hat;
}

Eigen::Vector3d LogSo3(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();  // sin(angle / 2)
  if (sine < 1e-8) return 2.0 * q.vec();
  return q.vec() * (2.0 * std::atan2(sine, q.w()) / sine);
}

Eigen::Matrix3d LeftJacobianSo3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d hat = Hat(w);
  const double a = angle < 1e-4 ? 0.5 - angle * angle / 24.0 : (1.0 - std::cos(angle)) / (angle * angle);
  const double b =
      angle < 1e-2 ? 1.0 / 6.0 - angle * angle / 120.0 : (angle - std::sin(angle)) / (angle * angle * angle);
  return Eigen::Matrix3d::Identity() + a * hat + b * hat * hat;
}

Pose Exp(const Vector6d& tangent) {
  Pose pose = Pose::Identity();
  pose.linear() = ExpSo3(tangent.tail<3>());
  pose.translation() = LeftJacobianSo3(tangent.tail<3>()) * tangent.head<3>();
  return pose;
}

Vector6d Log(const Pose& pose) {
  Vector6d tangent;
  tangent.tail<3>() = LogSo3(pose.linear());
  tangent.head<3>() = LeftJacobianSo3(tangent.tail<3>()).inverse() * pose.translation();
  return tangent;
}

// Sola et al., eq. 176.
Matrix6d Adjoint(const Pose& pose) {
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = pose.linear();
  adjoint.topRightCorner<3, 3>() = Hat(pose.translation()) * pose.linear();
  return adjoint;
}

Pose Interpolate(const Pose& T_w_a, const Pose& T_w_b, double share) {
  return T_w_a * Exp(share * Log(T_w_a.inverse() * T_w_b));
}

double Yaw(const Pose& T_w_b) { return std::atan2(T_w_b.linear()(1, 0), T_w_b.linear()(0, 0)); }

Pose FromXyYaw(double x_m, double y_m, double yaw_rad) {
  return Eigen::Translation3d(x_m, y_m, 0.0) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
}

}  // namespace merlin
