// The scenes that a camera is studied in: a single wall, one of the rooms, or geoms made for one experiment.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot/types/se3.h"
#include "sim/actors/actor_config.h"
#include "sim/rays/ray_scene.h"
#include "sim/tof/surroundings.h"
#include "sim/tof/tof_camera.h"
#include "sim/world/materials.h"
#include "sim/world/motion.h"

namespace merlin {

// T_body_optical: from the optical frame (z forward, x right, y down) to the body frame (x forward, y left, z up); REP 103.
Pose BodyOptical();

struct Stage {
  std::unique_ptr<mjModel, void (*)(mjModel*)> model{nullptr, mj_deleteModel};
  sim::Surroundings surroundings;
  sim::BodyMotions bodies;
  std::unique_ptr<sim::RayScene> scene;
  Pose T_world_optical = BodyOptical();

  sim::TofView View(const Eigen::Vector3d& velocity_world_m_s = {0, 0, 0}) const {
    return {*scene, surroundings, bodies, {T_world_optical, velocity_world_m_s, {0, 0, 0}}};
  }
};

// geoms: the content of a MuJoCo <worldbody>; material: one for each geom, in the same order. The camera stands at the
// world's origin and looks along x.
Stage BuildStage(const std::string& geoms, const std::vector<sim::Material>& material);

struct Wall {
  double distance_m = 2.0;  // optical z of its surface on the axis
  double albedo = 0.5;
  double tilt_rad = 0.0;  // about the vertical
  double ambient_w_m2_nm = 0.0;
};
// Throws InputError for a number outside its range: distance_m (0, 1000], albedo [0, 1], tilt +-89 degrees, ambient >=
// 0.
Stage WallStage(const Wall& wall);

struct RoomView {
  std::filesystem::path room, materials;
  bool curtain_closed = false;
  Pose T_world_body = Pose::Identity();    // of the camera: x forward, y left, z up
  std::optional<double> sun_w_m2_nm{};     // instead of the room's
  std::vector<sim::ActorConfig> actors{};  // away until stage.bodies puts them somewhere
};
// Throws InputError: a room or materials file that cannot be used, nothing to see in it, a camera inside a geom, a sun
// set where the room has none.
Stage RoomStage(const RoomView& view);

}  // namespace merlin
