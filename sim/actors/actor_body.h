// Actors and obstacles as mocap bodies of a MuJoCo model: their poses are set directly and forces do not move them.
// They touch the car like the room's geoms (sim/world/solid.h); a mesh collides as its convex hull.
#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "sim/actors/actor_config.h"

namespace merlin::sim {

// Height at which bodies are kept while they are not present: far below any floor.
constexpr double kAwayHeight_m = -50.0;

// The allowed values of ActorConfig::shape, and the count of numbers in size_m for each.
const std::vector<std::string>& ActorShapes();
std::size_t SizesOf(const std::string& shape);

// Names of the bodies and of their single geom: "actor_NAME", "obstacle_0". Geoms of a model: "actor_NAME_HEAD".
std::string BodyName(const ActorConfig& actor);
std::string ObstacleBodyName(std::size_t number);

// Adds the body at kAwayHeight_m. The config has passed RefuseFaults. Throws InputError for a model that is missing, is
// not MJCF, has joints or no geom, or has a plane, height field or signed distance field.
void AddActorBody(mjSpec* spec, const ActorConfig& actor);
void AddObstacleBody(mjSpec* spec, const ObstacleConfig& obstacle, std::size_t number);

}  // namespace merlin::sim
