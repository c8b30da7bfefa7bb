// MuJoCo's OpenGL renderer without a display: EGL (Mesa surfaceless) or OSMesa, chosen and loaded at run time.
// MuJoCo binds GL once a process: one back end per process. Any thread may call, one at a time.
#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "robot/types/camera_model.h"
#include "robot/types/gl.h"
#include "robot/types/se3.h"
#include "sim/world/motion.h"

namespace merlin::sim {

using merlin::Gl;

// How far a camera may move while it exposes.
struct Sway {
  double shift_m = 0.0;
  double turn_rad = 0.0;
};

// A geom of a snapshot whose body moves.
struct MovingGeom {
  int index;          // in the snapshot's scene
  BodyMotion motion;  // of the geom's frame, at the middle of the exposure
};

// What MuJoCo needs to draw, taken at exposure: the picture may be drawn later, beside the physics.
class RenderSnapshot {
 public:
  explicit RenderSnapshot(const mjModel* model);
  ~RenderSnapshot();
  RenderSnapshot(const RenderSnapshot&) = delete;
  RenderSnapshot& operator=(const RenderSnapshot&) = delete;
  // Camera: optical frame, its pinhole part only (no distortion). Keeps what can be in that camera's picture within
  // away_s of now, if bodies move so (empty: they do not).
  void Take(const mjModel* model, const mjData* data, const Pose& T_world_camera, const CameraModel& camera,
            const Sway& sway = {}, double away_s = 0.0, const BodyMotions& bodies = {});
  // Of what was kept; bodies as Take had them.
  std::vector<MovingGeom> MovingGeoms(const mjModel* model, const BodyMotions& bodies) const;
  // To where they are dt_s later than the snapshot.
  void Move(const std::vector<MovingGeom>& geoms, double dt_s);
  // The same world from another pose, no farther than the sway.
  void Look(const Pose& T_world_camera, const CameraModel& camera);
  mjvScene scene;
};

class Renderer {
 public:
  // Opens the back end (kAuto: EGL, else OSMesa) and an offscreen buffer of the camera's size, no multisampling, no
  // shadows. Throws MachineError when it cannot, naming what was tried. gl must not be kOff.
  Renderer(const mjModel* model, const CameraModel& camera, Gl gl);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // The pinhole picture as the snapshot's camera saw it, BGR, upper left first; out holds width * height * 3 bytes.
  void Draw(RenderSnapshot& snapshot, std::span<std::uint8_t> bgr);

  // "EGL: llvmpipe (LLVM 15.0.6, 256 bits)"
  const std::string& name() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin::sim
