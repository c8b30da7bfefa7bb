// The error of one edge and its derivatives, in space (SE(3)) and in the plane (SE(2)): two types with the same
// members.
//   E = measured^-1 (from^-1 to), error = (translation of E, rotation of E)
// A pose moves by a step (translation, rotation) in its own frame: t += R v, R = R Exp(w). Then
//   d error / d step of `to` = J, d error / d step of `from` = -J Adjoint((from^-1 to)^-1)
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "robot/types/se3.h"

namespace merlin {

// The rotation of E in the plane: its angle, wrapped (as in g2o), or the chord 2 sin(angle / 2), whose square is half
// of |R - I|^2. In space it is always the chord times the axis, which is twice the vector part of the quaternion.
enum class PlanarRotation { kAngle, kChord };

struct Spatial {
  static constexpr int kSize = 6;
  using Vector = Vector6d;
  using Matrix = Matrix6d;
  struct State {
    Eigen::Quaterniond q;
    Eigen::Vector3d t_m;
  };
  struct Linearized {
    Vector error;
    Matrix J_to, adjoint;
  };

  static Matrix Part(const Matrix6d& information) { return information; }
  static State Of(const Pose& pose) { return {Eigen::Quaterniond(pose.linear()).normalized(), pose.translation()}; }
  static Pose ToPose(const State& state) {
    Pose pose = Pose::Identity();
    pose.linear() = state.q.toRotationMatrix();
    pose.translation() = state.t_m;
    return pose;
  }
  static State Inverse(const State& a) { return {a.q.conjugate(), -(a.q.conjugate() * a.t_m)}; }
  static State Times(const State& a, const State& b) { return {a.q * b.q, a.t_m + a.q * b.t_m}; }

  static State Moved(const State& state, const Vector& step) {
    const Eigen::Vector3d half = 0.5 * step.tail<3>();
    const double angle = half.norm();
    const double scale = angle < 1e-4 ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
    Eigen::Quaterniond turn;
    turn.w() = std::cos(angle);
    turn.vec() = scale * half;
    return {(state.q * turn).normalized(), state.t_m + state.q * step.head<3>()};
  }

  static Vector ErrorOf(const State& E) {
    Vector error;
    error << E.t_m, std::copysign(2.0, E.q.w()) * E.q.vec();
    return error;
  }

  static Vector Error(const State& from, const State& to, const State& measured, PlanarRotation) {
    return ErrorOf(Times(Inverse(measured), Times(Inverse(from), to)));
  }

  static Linearized Linearize(const State& from, const State& to, const State& measured, PlanarRotation) {
    const State from_to = Times(Inverse(from), to);
    const State E = Times(Inverse(measured), from_to);
    const double sign = std::copysign(1.0, E.q.w());
    Linearized result;
    result.error = ErrorOf(E);
    result.J_to.setZero();
    result.J_to.topLeftCorner<3, 3>() = E.q.toRotationMatrix();
    // q (1, w / 2): its vector part changes by (q_w w + q_v x w) / 2
    result.J_to.bottomRightCorner<3, 3>() = sign * Hat(E.q.vec());
    result.J_to.bottomRightCorner<3, 3>().diagonal().array() += std::abs(E.q.w());
    result.adjoint = Adjoint(ToPose(Inverse(from_to)));
    return result;
  }
};

struct Planar {
  static constexpr int kSize = 3;
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;
  struct State {
    Eigen::Vector2d t_m;
    double yaw_rad;
  };
  struct Linearized {
    Vector error;
    Matrix J_to, adjoint;
  };

  static Matrix Part(const Matrix6d& information) {
    constexpr int kXyYaw[] = {0, 1, 5};
    return information(kXyYaw, kXyYaw);
  }
  static State Of(const Pose& pose) { return {pose.translation().head<2>(), Yaw(pose)}; }
  static Pose ToPose(const State& state) { return FromXyYaw(state.t_m.x(), state.t_m.y(), state.yaw_rad); }
  static Eigen::Matrix2d Rotation(double angle_rad) { return Eigen::Rotation2Dd(angle_rad).toRotationMatrix(); }
  static State Inverse(const State& a) { return {-(Rotation(-a.yaw_rad) * a.t_m), -a.yaw_rad}; }
  static State Times(const State& a, const State& b) {
    return {a.t_m + Rotation(a.yaw_rad) * b.t_m, WrapPi(a.yaw_rad + b.yaw_rad)};
  }

  static State Moved(const State& state, const Vector& step) {
    return {state.t_m + Rotation(state.yaw_rad) * step.head<2>(), WrapPi(state.yaw_rad + step.z())};
  }

  static Vector ErrorOf(const State& E, PlanarRotation rotation) {
    const bool angle = rotation == PlanarRotation::kAngle;
    return {E.t_m.x(), E.t_m.y(), angle ? E.yaw_rad : 2.0 * std::sin(0.5 * E.yaw_rad)};
  }

  static Vector Error(const State& from, const State& to, const State& measured, PlanarRotation rotation) {
    return ErrorOf(Times(Inverse(measured), Times(Inverse(from), to)), rotation);
  }

  static Linearized Linearize(const State& from, const State& to, const State& measured, PlanarRotation rotation) {
    const State from_to = Times(Inverse(from), to);
    const State E = Times(Inverse(measured), from_to);
    const State back = Inverse(from_to);
    Linearized result;
    result.error = ErrorOf(E, rotation);
    result.J_to.setIdentity();
    result.J_to.topLeftCorner<2, 2>() = Rotation(E.yaw_rad);
    if (rotation == PlanarRotation::kChord) result.J_to(2, 2) = std::cos(0.5 * E.yaw_rad);
    result.adjoint.setIdentity();
    result.adjoint.topLeftCorner<2, 2>() = Rotation(back.yaw_rad);
    result.adjoint.topRightCorner<2, 1>() << back.t_m.y(), -back.t_m.x();
    return result;
  }
};

}  // namespace merlin
