// All actors and obstacles of a world. Moves their bodies at every physics step, in this order:
//
//   mj_step2        moves the car
//   Move            moves actors to their poses at the new instant; waiting ones stay where they are
//   mj_step1        computes distances and contacts of the new instant
//   UpdateWaiting   decides which actors wait for the car from now on
//
// MuJoCo knows the pose of a mocap body but not its velocity; AddVelocities provides it for the cameras.
#pragma once

#include <mujoco/mujoco.h>

#include <optional>
#include <string>
#include <vector>

#include "robot/types/se3.h"
#include "robot/types/time.h"
#include "sim/actors/actor_config.h"
#include "sim/actors/timed_path.h"
#include "sim/world/motion.h"

namespace merlin::sim {

class Actors {
 public:
  // Adds the bodies to the spec. Throws InputError for what RefuseFaults or AddActorBody refuse.
  static void AddTo(mjSpec* spec, const std::vector<ActorConfig>& actors, const std::vector<ObstacleConfig>& obstacles);

  Actors() = default;
  // is_car: indexed by geom id. Nothing is present before the first Move.
  Actors(const mjModel* model, const std::vector<ActorConfig>& actors, const std::vector<ObstacleConfig>& obstacles,
         const std::vector<bool>& is_car);

  // Moves all bodies to their poses at this time. Time must not decrease between calls.
  void Move(mjData* data, Time now, const Pose& T_world_base);
  void UpdateWaiting(const mjModel* model, const mjData* data);

  // Sets the velocities of the actors' bodies.
  void AddVelocities(BodyMotions& bodies) const;
  // Appends pose (position, quaternion w x y z) and velocity (linear, angular) of every actor. Obstacles are left out:
  // their poses follow from the car's own state.
  void AddState(const mjData* data, std::vector<double>& state) const;

  std::size_t size() const { return all_.size(); }
  const std::string& name(std::size_t i) const { return all_[i].name; }  // the body's name
  bool present(std::size_t i) const { return all_[i].present; }
  // "file:line: actor 'NAME'", for messages; empty if the body is not an actor or obstacle.
  std::string Describe(int body) const;
  // Smallest distance from the car; max_m if it is farther away, negative if they overlap.
  double CarDistance_m(const mjModel* model, const mjData* data, std::size_t i, double max_m) const;

 private:
  struct One {
    std::string name, description;
    int body = -1, mocap = -1;
    std::optional<TimedPath> path{};  // none for an obstacle
    ObstacleConfig obstacle{};        // used if there is no path
    double begin_s = 0.0, until_s = HUGE_VAL, wait_m = 0.0;
    double waited_s = 0.0;  // delay on its path so far
    bool present = false, waits = false;
    BodyMotion motion{};
  };
  struct Nearest {
    double distance_m;
    Eigen::Vector3d toward_car{0, 0, 0};  // from the actor's nearest point to the car's; 0 if beyond max_m
  };
  Nearest NearestToCar(const mjModel* model, const mjData* data, const One& one, double max_m) const;
  void Put(mjData* data, One& one, const BodyMotion& motion) const;

  std::vector<One> all_;
  std::vector<int> car_geoms_;  // geoms of the car that collide
  Time last_{0};
};

}  // namespace merlin::sim
