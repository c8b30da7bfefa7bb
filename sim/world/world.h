// The world: a room (MJCF), the car (CarDescription) and actors in one MuJoCo model, stepped every 2 ms.
//
// One step, in its order:
//   drive       the commands of the drive and the pan servo become voltages and set points
//   mj_step2    forces and motion: qpos and qvel of the new instant
//   turntable   turns the car, where it is on one
//   actors      go to where they are at the new instant
//   mj_step1    poses, distances and contacts of the new instant
//   encoder     counts
//
// Frames: world (the room's; z up), base_link of the car (x forward, y left, z up, on the ground below the rear axle's
// middle). world_setup.cc makes the model; what a room has to offer and what the car touches of it: room.h, solid.h.
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
  Pose T_world_start = Pose::Identity();  // of base_link; its height is taken from the floor there (within 0.5 m of z)
  bool curtain_closed = false;  // geoms named "curtain*" hang where the room has them (true), or are not there (false)
  DrivetrainConfig drivetrain{};  // how the true car and its drive differ from the description
  Materials materials{};          // of the room: the grip of floors, what can be driven through
  std::uint64_t seed = 1;
  std::vector<ActorConfig> actors{};        // their models are files; materials are the caller's to know
  std::vector<ObstacleConfig> obstacles{};  // the same
  std::optional<double>
      turntable_rate_rad_s{};  // the car is on a turntable that turns this fast, > 0; none: on the floor
};

// Two geoms that touch, the first of them the car's. A wheel on a geom named "floor*" is no contact.
struct Touch {
  std::string car_geom;
  std::string other_geom;
};

class World {
 public:
  // The car touches whatever of the room its cameras see (sim/world/solid.h), and nothing of the room changes the car. Throws
  // InputError: a room that is missing or not MJCF (with its line where MuJoCo knows it), a missing mesh, a room
  // without a geom named "floor*", a curtain to close where there is none, a car that starts off the floor, in contact
  // with anything else or inside it, a drivetrain out of its ranges, a surface that is no material, a geom that cannot be made solid, an actor that is
  // wrong by itself (sim/actors), whose path leaves the room, or that is there from the start and touches the car (one
  // that comes later and finds the car in its place runs into it). Physics options (step, integrator, solver) are ours, whatever the room says.
  // Errors of MuJoCo itself throw std::runtime_error from then on, in the whole process; it prints and logs nothing.
  explicit World(const WorldOptions& options);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  static constexpr Duration kStep{2'000'000};

  // One physics step. Throws std::runtime_error when MuJoCo warns (bad state): the simulation stops loudly.
  // After it, positions, velocities and contacts in data() belong to the new state; accelerations, actuator and contact
  // forces to the step that led there.
  void Step();
  Time Now() const;
  Pose T_world_base() const;
  BodyMotion BaseMotion() const;
  // Of a camera whose pose in the car is this while the pan unit (if it moves) points ahead.
  BodyMotion CameraMotion(const Pose& T_base_camera) const;
  // Of every body, actors included.
  BodyMotions Motions() const;
  double Speed_m_s() const;  // of the rear axle's middle along x, signed
  std::vector<Touch> CarTouches() const;
  // Whether a wheel touches a geom named "floor*", or on anything else that is not the car and less than 45 degrees
  // steep where it touches.
  bool WheelTouchesGround() const;
  bool IsCarGeom(int geom_id) const;

  // What moves, or appears in the car's way.
  const Actors& actors() const { return actors_; }
  // Smallest distance between the car and an actor or obstacle that is there; max_m where it is farther, negative where
  // they overlap.
  double ActorDistance_m(std::size_t actor, double max_m) const {
    return actors_.CarDistance_m(model_.get(), data_.get(), actor, max_m);
  }

  DriveController& drive() { return drive_; }
  const DriveController& drive() const { return drive_; }

  // Null: the car has no pan unit that moves; it is not on a turntable.
  PanServo* pan() { return pan_ ? &*pan_ : nullptr; }
  const PanServo* pan() const { return pan_ ? &*pan_ : nullptr; }
  Turntable* turntable() { return turntable_ ? &*turntable_ : nullptr; }

  // Where the room behaves differently from what its file says, a sentence each.
  const std::vector<std::string>& warnings() const { return warnings_; }

  // The outer outline of the room ("plan_xy_m"), empty if the room gives none; yaw of magnetic north.
  const std::vector<Eigen::Vector2d>& plan_xy_m() const { return plan_xy_m_; }
  double north_yaw_rad() const { return north_yaw_rad_; }

  const mjModel* model() const { return model_.get(); }
  const mjData* data() const { return data_.get(); }

  // time, qpos, qvel, act, and where actors are and how fast: what the state hash is made of.
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
