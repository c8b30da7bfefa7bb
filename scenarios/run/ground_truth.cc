#include "scenarios/run/ground_truth.h"

#include <cmath>
#include <memory>
#include <span>

#include "robot/twin/twin.h"
#include "sim/rays/ray_scene.h"

namespace merlin {
namespace {

TrueRange RangeIn(const sim::World& world) {
  return [scene = std::make_shared<const sim::RayScene>(world.model(), CarBodies(world))](
             const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world) -> double {
    const sim::Ray ray{.origin = origin_world.cast<float>(), .direction = direction_world.cast<float>()};
    sim::RayHit hit;
    scene->Cast(std::span(&ray, 1), std::span(&hit, 1));
    return hit.range_m < 0.0f ? HUGE_VAL : hit.range_m;
  };
}

}  // namespace

GroundTruth GroundTruthOf(const Truth& truth, const sim::World& world) {
  return {.path = truth.trajectory(),
          .outline_m = world.plan_xy_m(),
          .collisions = truth.collisions(),
          .obstacle_gap_m = truth.obstacle_gap_m(),
          .obstacle_stop_s = truth.obstacle_stop_s(),
          .range_m = RangeIn(world),
          .state_hash = truth.state_hash()};
}

}  // namespace merlin
