// Rigid motions. A pose T_a_b is an Eigen::Isometry3d that maps coordinates in b to a: p_a = T_a_b * p_b.
// Tangent vectors are (translation [m], rotation [rad]); Exp and Log as in Sola, Deray, Atchuthan, "A micro Lie theory
// for state estimation in robotics" (2018), eq. 172-174, with series near zero. Compiled once: Eigen's products are slow to compile.
#pragma once

#include <Eigen/Geometry>

namespace merlin {

using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Angle in [-pi, pi]. Not finite in, not finite out.
double WrapPi(double angle_rad);

// The matrix of the cross product: Hat(v) w = v x w.
Eigen::Matrix3d Hat(const Eigen::Vector3d& v);

Eigen::Matrix3d ExpSo3(const Eigen::Vector3d& w);

// Rotation vector of length in [0, pi].
Eigen::Vector3d LogSo3(const Eigen::Matrix3d& rotation);

// The matrix V of eq. 174: translation = V(w) * first half of the tangent vector.
Eigen::Matrix3d LeftJacobianSo3(const Eigen::Vector3d& w);

Pose Exp(const Vector6d& tangent);
Vector6d Log(const Pose& pose);

// A small motion x after the pose is the small motion Adjoint(pose) x before it: pose Exp(x) = Exp(Adjoint(pose) x) pose.
Matrix6d Adjoint(const Pose& pose);

// Constant-velocity interpolation: T_w_a at share 0, T_w_b at share 1.
Pose Interpolate(const Pose& T_w_a, const Pose& T_w_b, double share);

// Yaw in (-pi, pi]: the direction of the body's x axis seen from above.
double Yaw(const Pose& T_w_b);

Pose FromXyYaw(double x_m, double y_m, double yaw_rad);

}  // namespace merlin
