// Casts rays into the MuJoCo model with Embree. It gives the answers of mj_ray, in single precision and many times
// faster.
//
// Rays meet every visible geom (group 0-2 and alpha > 0; where a geom has a material, the material's alpha counts).
// Planes are seen from above only, and infinite ones reach 1000 m each way; other geoms are seen from inside too.
// Everything fixed is one Embree scene. Every body that moves is an instance in a second one: Update moves the
// instances, and Cast asks both scenes. All coordinates are in the world frame.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/world/motion.h"

namespace merlin::sim {

constexpr int kNoFace = -1, kCurvedFace = -2;
constexpr float kClear_m = 1e-3f;  // a ray that leaves a surface begins this far from it

struct RayHit {
  float range_m = -1.0f;            // along the unit direction; negative: nothing within reach
  int geom = -1;                    // MuJoCo geom id
  int face = kNoFace;               // number of the plane that was met; kCurvedFace: no plane
  Eigen::Vector3f normal{0, 0, 0};  // unit, world frame, facing the ray's origin
};

// A plane that triangles of one geom lie in, in the world frame.
struct Face {
  int geom = -1;
  Eigen::Vector3f normal{0, 0, 0};  // unit
  float offset_m = 0.0f;            // normal . p of its points
};

struct Ray {
  Eigen::Vector3f origin{0, 0, 0};     // world
  Eigen::Vector3f direction{1, 0, 0};  // unit, world
  float max_range_m = 100.0f;          // farther hits do not count
};

// The geoms of a moving body, in the world.
struct Mover {
  int body = 0;
  Eigen::Vector3d middle{0, 0, 0};  // of the bounding sphere
  double radius_m = 0.0;
  double speed_m_s = 0.0;  // upper bound of the speed of their points
};

enum class Panes { kSeen, kLookedThrough };

class RayScene {
 public:
  // Places every body in the model's reference pose. Throws InputError for a geom that cannot be traced (height field,
  // signed distance field), MachineError if Embree does not start. skip_body(body_id): true leaves out the body's geoms
  // (those of the camera's own car). is_pane(geom_id): true for geoms that can be looked through; empty: none.
  RayScene(const mjModel* model, const std::vector<bool>& skip_body, const std::vector<bool>& is_pane = {});
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Moves the bodies to their poses dt_s later. Must not be called while rays are being traced.
  void Update(const BodyMotions& bodies, double dt_s = 0.0);
  // hits has the size of rays. Rays are traced in packets of eight in the given order, so the same call gives the same
  // bits. A caller that distributes rays over threads must split them independently of the number of threads.
  void Cast(std::span<const Ray> rays, std::span<RayHit> hits, Panes panes = Panes::kSeen) const;
  // blocked[i] = 1 if ray i hits anything before its max_range_m.
  void Occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, Panes panes) const;
  int BodyOf(int geom) const;
  // The planes that RayHit::face counts, at the poses of the last Update.
  const std::vector<Face>& faces() const;
  // The visible groups of moving bodies.
  std::vector<Mover> Movers(const BodyMotions& bodies) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin::sim
