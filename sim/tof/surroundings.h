// Properties of a room, besides its geometry, that a time-of-flight camera depends on: materials in the near infrared,
// sun, sky and lamps.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/world/materials.h"

namespace merlin::sim {

struct Sun {
  Eigen::Vector3d to_sun{0, 0, 1};  // unit, world
  double irradiance_w_m2_nm = 0.8;  // at 870 nm on a surface facing the sun; about 1 outdoors at noon
};

// A pane through which the sky lights the room: its middle, its normal (towards either side), its area.
struct Window {
  Eigen::Vector3d middle{0, 0, 0};
  Eigen::Vector3d normal{1, 0, 0};
  double area_m2 = 0.0;
};

struct Surroundings {
  std::vector<Material> material;  // [geom id]
  std::vector<int> material_id;    // [geom id] MuJoCo's, -1 without
  std::optional<Sun> sun;
  std::vector<Window> windows;
  double ambient_w_m2_nm = 0.0;  // spectral irradiance on every surface: lamps, or daylight in the open
  double temperature_c = 25.0;   // of the room
};

// The directional light named "sun" with the custom numeric "sun_w_m2_nm", box geoms named "window*" (of a material
// with glass_transmission), numerics "ambient_w_m2_nm" and "temperature_c" where the room gives them. Throws InputError
// for a number that is negative or not finite.
Surroundings SurroundingsOf(const mjModel* model, const Materials& materials);

// [geom id] whether it can be looked through; for RayScene.
std::vector<bool> PanesOf(const Surroundings& around);

}  // namespace merlin::sim
