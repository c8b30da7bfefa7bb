// The world: a room (MJCF) with the car (CarDescription) in it, stepped by MuJoCo.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot/types/car.h"
#include "robot/types/drivetrain_config.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"
#include "robot/types/time.h"
#include "sim/drive/drive_controller.h"
#include "sim/world/materials.h"
#include "sim/world/motion.h"
#include "sim/world/pan_servo.h"
#include "sim/world/turntable.h"

namespace merlin::sim {

// A box that scenarios put in the way; it waits far below the floor until it is placed.
struct Obstacle {
  std::string name;
  Eigen::Vector3d size_m{0.4, 0.4, 0.5};  // full edges
  std::string material{};                 // a name in materials.yaml
};

struct WorldOptions {
  std::filesystem::path room;
  CarDescription car;
  Pose T_world_start = Pose::Identity();  // of base_link; its height is taken from the floor there (within 0.5 m of z)
  std::vector<Obstacle> obstacles{};
  bool curtain_closed = false;  // geoms named "curtain*" hang where the room has them (true), or are not there (false)
  DrivetrainConfig drivetrain{};  // how the true car and its drive differ from the description
  Materials materials{};          // of the room: the grip of floors, what can be driven through
  std::uint64_t seed = 1;
  std::optional<double> stand_rate_rad_s{};  // the car stands on a turntable that turns as fast as this, > 0
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
  // with anything else or inside it, a drivetrain out of its ranges, a surface that is no material, a geom that cannot be made solid. Physics options (step, integrator, solver) are ours, whatever the room says.
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
  // Of a camera that sits there while the pan unit (if it moves) looks ahead.
  BodyMotion CameraMotion(const Pose& T_base_camera) const;
  double Speed_m_s() const;  // of the rear axle's middle along x, signed
  std::vector<Touch> CarTouches() const;
  // Whether a wheel stands on a geom named "floor*", or on anything else that is not the car and less than 45 degrees
  // steep where it touches.
  bool WheelTouchesGround() const;
  bool IsCarGeom(int geom_id) const;

  // Puts the obstacle's bottom centre at the pose, or takes it away again.
  void PlaceObstacle(const std::string& name, const Pose& T_world_obstacle);
  void RemoveObstacle(const std::string& name);
  // Smallest distance between the car and the obstacle; max_m where it is farther, negative where they overlap.
  // An unknown name is an InputError, here and above.
  double ObstacleDistance_m(const std::string& name, double max_m = 10.0) const;

  DriveController& drive() { return drive_; }
  const DriveController& drive() const { return drive_; }

  // Null: the car has none that moves; it stands on no turntable.
  PanServo* pan() { return pan_ ? &*pan_ : nullptr; }
  const PanServo* pan() const { return pan_ ? &*pan_ : nullptr; }
  Turntable* stand() { return stand_ ? &*stand_ : nullptr; }

  // What of the room is other than it seems, a sentence each.
  const std::vector<std::string>& warnings() const { return warnings_; }

  // The outer outline of the room ("plan_xy_m"), empty if the room gives none; yaw of magnetic north.
  const std::vector<Eigen::Vector2d>& plan_xy_m() const { return plan_xy_m_; }
  double north_yaw_rad() const { return north_yaw_rad_; }

  const mjModel* model() const { return model_.get(); }
  const mjData* data() const { return data_.get(); }

  // time, qpos, qvel, act: what the state hash is made of.
  std::vector<double> State() const;

 private:
  void AddObstacles(mjSpec* spec, const std::vector<Obstacle>& obstacles) const;
  void ReadNumerics(const std::string& room);
  void NameParts(const CarDescription& car, const std::vector<Obstacle>& obstacles);
  void PutOnFloor(const WorldOptions& options);
  void RefuseStartInContact(const WorldOptions& options) const;
  void MoveObstacle(const std::string& name, const Pose& T_world_obstacle);
  int ObstacleBody(const std::string& name) const;

  std::unique_ptr<mjModel, void (*)(mjModel*)> model_{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, void (*)(mjData*)> data_{nullptr, mj_deleteData};
  void TurnOnStand();

  DriveController drive_;
  std::optional<PanServo> pan_;
  std::optional<Turntable> stand_;
  CarDescription car_;
  int base_body_ = -1, pan_body_ = -1;
  double wheel_radius_m_ = 0.0;
  std::vector<bool> is_car_, is_wheel_, is_floor_;  // by geom
  std::vector<std::string> warnings_;
  std::map<std::string, int> obstacle_bodies_;
  std::vector<Eigen::Vector2d> plan_xy_m_;
  double north_yaw_rad_ = 0.0;
};

}  // namespace merlin::sim
