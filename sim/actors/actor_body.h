// Actors and obstacles as bodies of a MuJoCo model: mocap bodies, which go wherever they are told and which no force
// moves. They touch the car as everything in the room does (sim/world/solid.h); a mesh collides as its convex hull.
#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "sim/actors/actor_config.h"

namespace merlin::sim {

// Where bodies wait while they are not there: far below any floor.
constexpr double kAwayHeight_m = -50.0;

// What ActorConfig::shape may be, and how many numbers its size_m has then.
const std::vector<std::string>& ActorShapes();
std::size_t SizesOf(const std::string& shape);

// Names of bodies, and of the geom where there is one: "actor_NAME" and "obstacle_0". A model's geoms: "actor_NAME_HEAD".
std::string BodyName(const ActorConfig& actor);
std::string ObstacleBodyName(std::size_t number);

// Adds the body, away. The config is sound (RefuseFaults). Throws InputError for a model that is missing, is not MJCF, or
// has joints, no geom, or a geom without an end (plane, height field, signed distance field).
void AddActorBody(mjSpec* spec, const ActorConfig& actor);
void AddObstacleBody(mjSpec* spec, const ObstacleConfig& obstacle, std::size_t number);

}  // namespace merlin::sim
