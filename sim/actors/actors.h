// All actors and obstacles of a world: moves their bodies at every physics step.
//
//   mj_step2   the car moves
//   Move       actors go to where they are at the new instant, by what Look saw before
//   mj_step1   distances and contacts of the new instant
//   Look       who waits for the car now
//
// MuJoCo knows where a mocap body is and not how fast it goes: cameras ask AddVelocities.
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
  // is_car: by geom. Nothing is there before the first Move.
  Actors(const mjModel* model, const std::vector<ActorConfig>& actors, const std::vector<ObstacleConfig>& obstacles,
         const std::vector<bool>& is_car);

  // To where they are at this time, which never goes back.
  void Move(mjData* data, Time now, const Pose& T_world_base);
  void Look(const mjModel* model, const mjData* data);

  // Gives the bodies of these motions the velocities that MuJoCo does not know.
  void AddVelocities(BodyMotions& bodies) const;
  // Pose (position, quaternion w x y z) and velocity (linear, angular) of every actor; of obstacles nothing, which stand
  // where the car's own state has put them.
  void AddState(const mjData* data, std::vector<double>& state) const;

  std::size_t size() const { return all_.size(); }
  const std::string& name(std::size_t i) const { return all_[i].name; }  // of its body
  bool present(std::size_t i) const { return all_[i].present; }
  // "file:line: actor 'NAME'", for messages; empty: the body is none of these.
  std::string Describe(int body) const;
  // Smallest distance from the car; max_m where it is farther, negative where they overlap.
  double CarDistance_m(const mjModel* model, const mjData* data, std::size_t i, double max_m) const;

 private:
  struct One {
    std::string name, description;
    int body = -1, mocap = -1;
    std::optional<TimedPath> path{};  // none: an obstacle
    ObstacleConfig obstacle{};        // where it has no path
    double begin_s = 0.0, until_s = HUGE_VAL, wait_m = 0.0;
    double waited_s = 0.0;  // by how much it is late on its path
    bool present = false, waits = false;
    BodyMotion motion{};
  };
  struct Nearest {
    double distance_m;
    Eigen::Vector3d toward_car{0, 0, 0};  // from the actor's nearest point to the car's; 0: beyond max_m
  };
  Nearest NearestToCar(const mjModel* model, const mjData* data, const One& one, double max_m) const;
  void Put(mjData* data, One& one, const BodyMotion& motion) const;

  std::vector<One> all_;
  std::vector<int> car_geoms_;  // those that collide
  Time last_{0};
};

}  // namespace merlin::sim
