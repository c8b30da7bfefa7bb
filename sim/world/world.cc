#include "sim/world/world.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/world/room.h"
#include "sim/world/solid.h"

namespace merlin::sim {

World::~World() = default;

void World::Step() {
  drive_.Apply(model_.get(), data_.get(), Now());
  if (pan_) pan_->Apply(data_.get());
  // mj_step1 of this step has already run at the end of the last one, so that everything in data that depends on
  // position and velocity is current between steps.
  mj_step2(model_.get(), data_.get());
  if (turntable_) TurnOnTurntable();
  actors_.Move(data_.get(), Now(), T_world_base());
  mj_step1(model_.get(), data_.get());
  actors_.UpdateWaiting(model_.get(), data_.get());
  for (int i = 0; i < mjNWARNING; ++i)
    if (data_->warning[i].number > 0)
      throw std::runtime_error(
          fmt::format("MuJoCo stopped at {:.3f} s: {}", data_->time, mju_warningText(i, data_->warning[i].lastinfo)));
  drive_.Follow(model_.get(), data_.get());  // after the check, because a bad state has no valid counts
}

// Overwrites the car's pose and velocity with those of the turntable.
void World::TurnOnTurntable() {
  turntable_->Step(kStep);
  const Pose T_world_base = turntable_->T_world_base();
  const Eigen::Quaterniond q(T_world_base.linear());
  const Eigen::Vector3d axle =
      T_world_base.linear() * car_.T_base_turntable().translation();  // from the base to the axis
  const Eigen::Vector3d turn(0.0, 0.0, turntable_->speed_rad_s());
  const int joint = model_->body_jntadr[base_body_];
  mjtNum *position = data_->qpos + model_->jnt_qposadr[joint], *velocity = data_->qvel + model_->jnt_dofadr[joint];
  Eigen::Vector3d::Map(position) = T_world_base.translation();
  Eigen::Vector4d::Map(position + 3) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  Eigen::Vector3d::Map(velocity) = turn.cross(-axle);
  Eigen::Vector3d::Map(velocity + 3) = turn;  // in body axes, where z equals the world's z
}

Time World::Now() const { return std::llround(data_->time / Seconds(kStep)) * kStep; }

Pose World::T_world_base() const {
  const mjtNum* q = data_->qpos + model_->jnt_qposadr[model_->body_jntadr[base_body_]];
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(q[0], q[1], q[2]);
  pose.linear() = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
  return pose;
}

BodyMotion World::BaseMotion() const {
  mjtNum velocity[6];  // angular, linear
  mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, base_body_, velocity, 0);
  return {T_world_base(), {velocity[3], velocity[4], velocity[5]}, {velocity[0], velocity[1], velocity[2]}};
}

BodyMotion World::CameraMotion(const Pose& T_base_camera) const {
  if (!pan_) return BaseMotion().Of(T_base_camera);
  const BodyMotion base = BaseMotion();
  BodyMotion camera = base.Of(car_.pan->Turned(T_base_camera, pan_->Read_rad(data_.get())));
  mjtNum velocity[6];  // angular, linear
  mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, pan_body_, velocity, 0);
  const Eigen::Vector3d turn(velocity[0], velocity[1], velocity[2]);
  const Eigen::Vector3d pivot = base.T_world_body * car_.pan->T_base_pan.translation();
  camera.velocity_m_s =
      Eigen::Vector3d(velocity[3], velocity[4], velocity[5]) + turn.cross(camera.T_world_body.translation() - pivot);
  camera.angular_velocity_rad_s = turn;
  return camera;
}

BodyMotions World::Motions() const {
  BodyMotions bodies = MotionsOf(model_.get(), data_.get());
  actors_.AddVelocities(bodies);
  return bodies;
}

double World::Speed_m_s() const {
  // A free joint's linear velocity is that of the body's origin in world axes; its angular velocity is in body axes.
  const mjtNum* v = data_->qvel + model_->jnt_dofadr[model_->body_jntadr[base_body_]];
  const Eigen::Vector3d forward_world = T_world_base().linear().col(0);
  return forward_world.dot(Eigen::Vector3d(v[0], v[1], v[2])) + v[4] * wheel_radius_m_;
}

std::vector<Touch> World::CarTouches() const {
  std::vector<Touch> touches;
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    int car = contact.geom[0], other = contact.geom[1];
    if (car < 0 || other < 0 || contact.dist > 0.0) continue;  // flexes have no geom
    if (!is_car_[car]) std::swap(car, other);
    if (!is_car_[car] || is_car_[other] || (is_wheel_[car] && is_floor_[other])) continue;
    touches.push_back({GeomName(model_.get(), car), SeenName(model_.get(), other)});
  }
  return touches;
}

bool World::WheelTouchesGround() const {
  constexpr double kLevel = 0.7071;  // cosine of 45 degrees
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    int wheel = contact.geom[0], ground = contact.geom[1];
    if (wheel < 0 || ground < 0 || contact.dist > 0.0) continue;
    if (!is_wheel_[wheel]) std::swap(wheel, ground);
    if (!is_wheel_[wheel] || is_car_[ground]) continue;
    if (is_floor_[ground] || std::abs(contact.frame[2]) > kLevel) return true;
  }
  return false;
}

bool World::IsCarGeom(int geom_id) const { return is_car_.at(static_cast<std::size_t>(geom_id)); }

std::vector<double> World::State() const {
  constexpr int kParts = mjSTATE_TIME | mjSTATE_QPOS | mjSTATE_QVEL | mjSTATE_ACT;
  std::vector<double> state(static_cast<std::size_t>(mj_stateSize(model_.get(), kParts)));
  mj_getState(model_.get(), data_.get(), state.data(), kParts);
  actors_.AddState(data_.get(), state);
  return state;
}

}  // namespace merlin::sim
