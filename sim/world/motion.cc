#include "sim/world/motion.h"

#include "sim/rays/ray_group.h"

namespace merlin::sim {

BodyMotions MotionsOf(const mjModel* model, const mjData* data) {
  BodyMotions bodies;
  for (int b = 0; b < model->nbody; ++b) {
    mjtNum velocity[6] = {0, 0, 0, 0, 0, 0};  // angular, linear
    if (model->body_weldid[b] != 0) mj_objectVelocity(model, data, mjOBJ_XBODY, b, velocity, 0);
    bodies.push_back({ToPose(data->xpos + 3 * b, data->xquat + 4 * b),
                      {velocity[3], velocity[4], velocity[5]},
                      {velocity[0], velocity[1], velocity[2]}});
  }
  return bodies;
}

BodyMotions AtRest(const mjModel* model) {
  BodyMotions bodies;
  for (const Pose& T_world_body : ReferencePoses(model)) bodies.push_back({.T_world_body = T_world_body});
  return bodies;
}

}  // namespace merlin::sim
