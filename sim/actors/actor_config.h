// Actors and obstacles as a scenario describes them. An actor follows a path with given times, independent of the car
// unless it waits for it. An obstacle appears ahead of the car at a given time and does not move.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/base/config.h"

namespace merlin::sim {

// An actor has either a model (an MJCF file) or one shape. Its frame: x forward, y left, z up, origin on the ground
// below its middle.
struct ActorConfig {
  std::string name{};   // letters, digits, '_' and '-'; unique
  std::string model{};  // an MJCF file; geoms, meshes and colours are used, textures are not; must not have joints
  std::string shape{};  // box, sphere, capsule, cylinder or ellipsoid; for a mesh use a model
  // Full dimensions of the shape [m]. Box and ellipsoid: length, width, height. Capsule (with its caps) and cylinder:
  // diameter, height. Sphere: diameter.
  std::vector<double> size_m{};
  std::string material{};  // of the shape: a name in materials.yaml; empty: the default material
  // Points [t_s, x_m, y_m], [t_s, x_m, y_m, yaw_rad] or [t_s, x_m, y_m, yaw_rad, z_m] of the actor's frame in the
  // world, all of the same length; t_s starts at 0 or later and increases. Linear between points (also in yaw: from 0
  // to 6.28 is a full turn), at rest after the last. Without yaw the actor faces its direction of motion. It appears at
  // the first t_s.
  std::vector<std::vector<double>> path{};
  // The actor stops while the car is nearer than this ahead of it, and then continues with that delay; 0: never stops.
  double wait_for_car_m = 0.0;
  std::optional<double> until_s{};  // run time at which it disappears; none: never
  std::string where{};              // "file:line" in the scenario, for messages; not a key
};

template <class Visitor>
void Visit(Visitor& v, ActorConfig& c) {
  v("name", c.name);
  v("model", c.model);
  v("shape", c.shape);
  v("size_m", c.size_m, {0.01, 100.0});
  v("material", c.material);
  v("path", c.path);
  v("wait_for_car_m", c.wait_for_car_m, {0.0, 100.0});
  v("until_s", c.until_s, {0.0, 1e6});
}

// A box that appears ahead of the car and disappears again.
struct ObstacleConfig {
  double appear_s = 0.0;  // run time
  double disappear_s = 1e6;
  double ahead_m = 3.0;   // distance of its near face from base_link, along the car's heading when it appears
  double left_m = 0.0;    // offset of its middle to the left of that line
  double length_m = 0.4;  // along the heading; width across it, height upwards
  double width_m = 0.4;
  double height_m = 0.5;
  std::string material = "dark_box";
  std::string where{};  // "file:line" in the scenario, for messages; not a key
};

template <class Visitor>
void Visit(Visitor& v, ObstacleConfig& c) {
  v("appear_s", c.appear_s, {0.0, 1e6});
  v("disappear_s", c.disappear_s, {0.0, 1e6});
  v("ahead_m", c.ahead_m, {0.0, 100.0});
  v("left_m", c.left_m, {-100.0, 100.0});
  v("length_m", c.length_m, {0.01, 10.0});
  v("width_m", c.width_m, {0.01, 10.0});
  v("height_m", c.height_m, {0.01, 10.0});
  v("material", c.material);
}

// Throws InputError with one line for each fault in names, model and shape, sizes, paths and times. World checks what
// depends on the room and the car.
void RefuseFaults(const std::vector<ActorConfig>& actors);

}  // namespace merlin::sim
