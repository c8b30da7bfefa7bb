// What stands in the car's way or moves about, as a scenario describes it. An actor goes along a path at given times,
// whatever the car does (unless it waits for the car); an obstacle appears ahead of the car at an instant and stays.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/base/config.h"

namespace merlin::sim {

// Made of a model (an MJCF file) or of one shape, not of both. Its frame: x forward, y left, z up, the origin on the
// ground below its middle.
struct ActorConfig {
  std::string name{};   // letters, digits, '_' and '-'; no two actors share one
  std::string model{};  // an MJCF file: geoms, meshes and colours count, textures do not; joints are refused
  std::string shape{};  // box, sphere, capsule, cylinder or ellipsoid; a mesh comes in a model
  // Full edges of the shape [m]: box and ellipsoid length, width, height; capsule (caps included) and cylinder diameter,
  // height; sphere diameter.
  std::vector<double> size_m{};
  std::string material{};  // of the shape: a name in materials.yaml; empty: what an unnamed material is
  // Points [t_s, x_m, y_m], [t_s, x_m, y_m, yaw_rad] or [t_s, x_m, y_m, yaw_rad, z_m] of the actor's frame in the world,
  // all of one length; t_s grows, from 0 on. Linear in between (yaw, too: 0 to 6.28 is a whole turn), at rest after the
  // last. Without yaw the actor faces where it goes. It is not there before the first time.
  std::vector<std::vector<double>> path{};
  // While the car is nearer than this ahead of it, it stands still, and goes on later by as much; 0: it never waits.
  double wait_for_car_m = 0.0;
  std::optional<double> until_s{};  // run time from when on it is gone; none: it stays
  std::string where{};              // "file:line" of its description, for messages; not a key of it
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

// A box that appears ahead of the car and goes away again.
struct ObstacleConfig {
  double appear_s = 0.0;  // run time
  double disappear_s = 1e6;
  double ahead_m = 3.0;   // its near face before the car's base_link along the car's heading at that instant
  double left_m = 0.0;    // its middle to the left of it
  double length_m = 0.4;  // edges along the heading, across, up
  double width_m = 0.4;
  double height_m = 0.5;
  std::string material = "dark_box";
  std::string where{};  // "file:line" of its description, for messages; not a key of it
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

// Throws InputError for everything in these actors that is wrong by itself, a line each: names, model and shape, sizes,
// paths, times. What depends on the room and the car, the world refuses.
void RefuseFaults(const std::vector<ActorConfig>& actors);

}  // namespace merlin::sim
