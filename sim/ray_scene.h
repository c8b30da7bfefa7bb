// Embree's view of the MuJoCo model: rays against every visible geom (group 0-2, alpha > 0: the material's where there
// is one), moving bodies included. What mj_ray would say, in float and faster: planes are seen from above only
// (infinite ones reach 1000 m each way), other geoms from inside, too.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "robot/types/se3.h"

namespace merlin::sim {

struct RayHit {
  float range_m = -1.0f;            // along the unit direction; negative: nothing within reach
  int geom = -1;                    // MuJoCo geom id
  Eigen::Vector3f normal{0, 0, 0};  // unit, world frame, facing the ray's origin
};

// Where every body stands, taken at exposure: rays may be traced later, beside the physics.
struct BodyPoses {
  std::vector<Pose> T_world_body;
};

class RayScene {
 public:
  // Every body where the model puts it. Throws InputError for a geom it cannot see (height field, signed distance
  // field), MachineError when Embree does not start. Geoms of the bodies for which skip_body(body_id) is true are left
  // out (the camera's own car).
  RayScene(const mjModel* model, const std::vector<bool>& skip_body);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  static BodyPoses Snapshot(const mjModel* model, const mjData* data);
  // Moves the instances. Not to be called while rays are traced.
  void Update(const BodyPoses& poses);
  // One origin, many unit directions (world frame); hits has the same size. max_range_m: beyond it nothing is seen.
  // A hit depends on its ray alone, to the bit, not on the others of the call: rays may be split between threads.
  void Cast(const Eigen::Vector3d& origin_world, std::span<const Eigen::Vector3f> directions_world,
            std::span<RayHit> hits, float max_range_m = 100.0f) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin::sim
