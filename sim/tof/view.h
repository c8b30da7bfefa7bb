// The scene that a frame is taken of, and how it and the camera move.
#pragma once

#include "sim/rays/ray_scene.h"
#include "sim/tof/surroundings.h"
#include "sim/world/motion.h"

namespace merlin::sim {

// camera: the optical frame at mid-exposure. It and the bodies move at constant velocity through the sub-frames.
struct TofView {
  RayScene& scene;
  const Surroundings& surroundings;
  const BodyMotions& bodies;
  BodyMotion camera;
};

}  // namespace merlin::sim
