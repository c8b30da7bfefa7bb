// The world: a room (MJCF), the car (CarDescription) and actors in one MuJoCo model, simulated in steps of 2 ms.
//
// A step, in this order:
//   drive       turns the commands for drive and pan servo into voltages and set points
//   mj_step2    forces and motion: qpos and qvel of the new instant
//   turntable   turns the car, where it is on one
//   actors      move to their poses at the new instant
//   mj_step1    poses, distances and contacts of the new instant
//   encoder     counts
//
// Frames: world (that of the room; z up) and base_link of the car (x forward, y left, z up; origin on the ground below
// the middle of the rear axle). world_setup.cc builds the model. room.h says what a room must have, solid.h what the
// car can touch.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot/types/car.h"
#include "robot/types/drivetrain_config.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"
#include "robot/types/time.h"
#include "sim/actors/actors.h"
#include "sim/drive/drive_controller.h"
#include "sim/world/materials.h"
#include "sim/world/motion.h"
#include "sim/world/pan_servo.h"
#include "sim/world/turntable.h"

namespace merlin::sim {

struct WorldOptions {
  std::filesystem::path room;
  CarDescription car;
  Pose T_world_start = Pose::Identity();  // of base_link; z is set to the height of the floor there (within 0.5 m)
  bool curtain_closed = false;            // true: geoms named "curtain*" are kept; false: they are removed
  DrivetrainConfig drivetrain{};          // how the true car and its drive differ from the description
  Materials materials{};                  // of the room: the grip of floors, and what the car can drive through
  std::uint64_t seed = 1;
  std::vector<ActorConfig> actors{};  // models are paths of files; the caller checks that the materials exist
  std::vector<ObstacleConfig> obstacles{};
  std::optional<double> turntable_rate_rad_s{};  // the car is on a turntable of this rate, > 0; none: on the floor
};

// A contact between a geom of the car and another geom. A wheel on a geom named "floor*" does not count as one.
struct Touch {
  std::string car_geom;
  std::string other_geom;
};

class World {
 public:
  // The car can touch all parts of the room that its cameras see (sim/world/solid.h). Nothing in the room's file
  // changes the car, and the physics options (step, integrator, solver) are ours. Throws InputError for
  //  - a room that is missing, is not MJCF (with the line if MuJoCo names it), lacks a mesh or a geom named "floor*",
  //    or has no curtain although one is to be closed;
  //  - a geom that is seen but cannot be made solid;
  //  - a car that does not start on the floor, or starts in contact with or inside something else;
  //  - drivetrain values out of range, or a surface that is not a material;
  //  - an actor with a fault of its own (sim/actors), with a path that leaves the room, or that is present at the start
  //    and touches the car. An actor that appears later may appear inside the car, which then counts as a collision.
  // After this call, and in the whole process, MuJoCo throws std::runtime_error on an error and prints and logs
  // nothing.
  explicit World(const WorldOptions& options);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  static constexpr Duration kStep{2'000'000};

  // One physics step. Throws std::runtime_error if MuJoCo warns (of a bad state, for example). Afterwards positions,
  // velocities and contacts in data() belong to the new state; accelerations, actuator and contact forces belong to the
  // step that led to it.
  void Step();
  Time Now() const;
  Pose T_world_base() const;
  BodyMotion BaseMotion() const;
  // Motion of a camera. T_base_camera: its pose in the car while the pan unit (if it moves) points ahead.
  BodyMotion CameraMotion(const Pose& T_base_camera) const;
  // Motion of every body, actors included.
  BodyMotions Motions() const;
  double Speed_m_s() const;  // of the middle of the rear axle along x, signed
  std::vector<Touch> CarTouches() const;
  // Whether a wheel touches a geom named "floor*", or any other geom (not of the car) where it slopes less than 45 deg.
  bool WheelTouchesGround() const;
  bool IsCarGeom(int geom_id) const;

  // Actors and obstacles.
  const Actors& actors() const { return actors_; }
  // Smallest distance between the car and an actor or obstacle that is present; max_m if it is farther away, negative
  // if they overlap.
  double ActorDistance_m(std::size_t actor, double max_m) const {
    return actors_.CarDistance_m(model_.get(), data_.get(), actor, max_m);
  }

  DriveController& drive() { return drive_; }
  const DriveController& drive() const { return drive_; }

  // Null if the car has no movable pan unit, or is not on a turntable.
  PanServo* pan() { return pan_ ? &*pan_ : nullptr; }
  const PanServo* pan() const { return pan_ ? &*pan_ : nullptr; }
  Turntable* turntable() { return turntable_ ? &*turntable_ : nullptr; }

  // Where the simulation departs from the room's file, one sentence each.
  const std::vector<std::string>& warnings() const { return warnings_; }

  // The outer outline of the room ("plan_xy_m"), empty if the room has none; and the yaw of magnetic north.
  const std::vector<Eigen::Vector2d>& plan_xy_m() const { return plan_xy_m_; }
  double north_yaw_rad() const { return north_yaw_rad_; }

  const mjModel* model() const { return model_.get(); }
  const mjData* data() const { return data_.get(); }

  // The input of the state hash: time, qpos, qvel, act, then pose and velocity of every actor.
  std::vector<double> State() const;

 private:
  void ReadNumerics(const std::string& room);
  void NameParts(const CarDescription& car);
  void PutOnFloor(const WorldOptions& options);
  void RefuseGeomsNowhere(const std::string& room) const;
  void RefuseStartInContact(const WorldOptions& options) const;
  void RefusePathsOutOfTheRoom(const std::vector<ActorConfig>& actors) const;

  std::unique_ptr<mjModel, void (*)(mjModel*)> model_{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, void (*)(mjData*)> data_{nullptr, mj_deleteData};
  void TurnOnTurntable();

  DriveController drive_;
  std::optional<PanServo> pan_;
  std::optional<Turntable> turntable_;
  CarDescription car_;
  int base_body_ = -1, pan_body_ = -1;
  double wheel_radius_m_ = 0.0;
  std::vector<bool> is_car_, is_wheel_, is_floor_;  // by geom
  std::vector<std::string> warnings_;
  Actors actors_;
  std::vector<Eigen::Vector2d> plan_xy_m_;
  double north_yaw_rad_ = 0.0;
};

}  // namespace merlin::sim
