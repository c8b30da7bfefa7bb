// MuJoCo's OpenGL renderer without a display, through EGL (Mesa surfaceless) or OSMesa, chosen and loaded at run time.
// MuJoCo binds GL once per process, so a process can use only one of them. Any thread may call, one at a time.
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

// Upper bound of a camera's motion from the middle of the exposure to its beginning or end.
struct MotionBound {
  double shift_m = 0.0;
  double turn_rad = 0.0;
};

// A geom of a snapshot whose body moves.
struct MovingGeom {
  int index;          // in the snapshot's scene
  BodyMotion motion;  // of the geom's frame, at the middle of the exposure
};

// All that MuJoCo needs to draw a picture, copied at exposure. The picture can be drawn later, in parallel with the
// physics.
class RenderSnapshot {
 public:
  explicit RenderSnapshot(const mjModel* model);
  ~RenderSnapshot();
  RenderSnapshot(const RenderSnapshot&) = delete;
  RenderSnapshot& operator=(const RenderSnapshot&) = delete;
  // Copies the geoms that can appear in the camera's picture within half_exposure_s before or after now. T_world_camera
  // is the optical frame; distortion of the camera is ignored. bodies: their motions; empty if all are at rest.
  void Take(const mjModel* model, const mjData* data, const Pose& T_world_camera, const CameraModel& camera,
            const MotionBound& bound = {}, double half_exposure_s = 0.0, const BodyMotions& bodies = {});
  // The copied geoms whose bodies move. bodies: the same as for Take.
  std::vector<MovingGeom> MovingGeoms(const mjModel* model, const BodyMotions& bodies) const;
  // Moves these geoms to their poses dt_s after the snapshot.
  void Move(const std::vector<MovingGeom>& geoms, double dt_s);
  // Sets the pose from which to draw, within the bound given to Take.
  void SetCamera(const Pose& T_world_camera, const CameraModel& camera);
  mjvScene scene;
};

class Renderer {
 public:
  // Opens the back end (kAuto: EGL, else OSMesa) and an offscreen buffer of the camera's size, without multisampling
  // and shadows. Throws MachineError if that fails, with the back ends tried. gl must not be kOff.
  Renderer(const mjModel* model, const CameraModel& camera, Gl gl);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Draws the pinhole picture of the snapshot's camera: BGR, upper left pixel first, width * height * 3 bytes.
  void Draw(RenderSnapshot& snapshot, std::span<std::uint8_t> bgr);

  // "EGL: llvmpipe (LLVM 15.0.6, 256 bits)"
  const std::string& name() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin::sim
