// Poses and velocities of bodies at one instant, from which their motion during an exposure (milliseconds) follows.
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "robot/types/se3.h"

namespace merlin::sim {

struct BodyMotion {
  Pose T_world_body = Pose::Identity();
  Eigen::Vector3d velocity_m_s{0, 0, 0};            // of the body's origin, world frame
  Eigen::Vector3d angular_velocity_rad_s{0, 0, 0};  // world frame

  bool still() const { return velocity_m_s.isZero(0.0) && angular_velocity_rad_s.isZero(0.0); }
  // The pose dt_s later at constant velocity. An acceleration of 2 m/s^2 would add 0.1 mm over an exposure of 10 ms.
  Pose At(double dt_s) const {
    const Eigen::Vector3d turn_rad = dt_s * angular_velocity_rad_s;
    const double angle_rad = turn_rad.norm();
    Pose pose = T_world_body;
    pose.translation() += dt_s * velocity_m_s;
    if (angle_rad > 0.0) pose.linear() = Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad) * T_world_body.linear();
    return pose;
  }
  // The motion of a part that is fixed to this body.
  BodyMotion Of(const Pose& T_body_part) const {
    const Pose T_world_part = T_world_body * T_body_part;
    return {T_world_part,
            velocity_m_s + angular_velocity_rad_s.cross(T_world_part.translation() - T_world_body.translation()),
            angular_velocity_rad_s};
  }
};

using BodyMotions = std::vector<BodyMotion>;  // [body id]

// The motion of every body in the current state.
BodyMotions MotionsOf(const mjModel* model, const mjData* data);
// Every body at rest in the model's reference pose.
BodyMotions AtRest(const mjModel* model);

}  // namespace merlin::sim
