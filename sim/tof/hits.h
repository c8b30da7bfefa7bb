// What the sub-rays of a frame meet: all of them at mid-exposure, then again in every sub-frame as camera and bodies
// move.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/motion.h"
#include "sim/ray_scene.h"
#include "sim/tof/optics.h"

namespace merlin::sim {

// At mid-exposure, of every sub-ray.
struct MidHits {
  Pose T_world_camera;
  std::vector<Ray> rays;            // [pixel * per_pixel + sub-ray], world
  std::vector<RayHit> hits;         // the same
  std::vector<std::uint8_t> mixed;  // [pixel] its sub-rays do not all meet one plane of one geom
  // [pixel] it and its eight neighbours see nothing but one plane of one geom: as long as the picture moves by less
  // than a pixel, a sub-ray still meets that plane, and where is a matter of one division.
  std::vector<std::uint8_t> flat;

  Eigen::Vector3f Point(std::size_t i) const { return rays[i].origin + hits[i].range_m * rays[i].direction; }
};
MidHits TraceMid(const RayScene& scene, const Optics& optics, const Pose& T_world_camera, int threads);

// Of the sub-rays of one row of pixels in one sub-frame; vectors in the optical frame of the sub-ray's own instant.
struct RowHits {
  std::vector<float> range_m;  // negative: nothing
  std::vector<float> normal_x, normal_y, normal_z;
  std::vector<int> geom;
  void Resize(std::size_t n);
};

// When the sub-frames are taken: sub-ray (i, j) of a pixel sees the instant number (i + j) mod 3 of the three into
// which its integration is cut: a moving edge blurs, and no more rays are traced for it.
struct SubFrame {
  double begin_s = 0.0;  // from mid-exposure
  double integration_s = 0.0;
  static constexpr int kInstants = 3;
  double Instant_s(int i) const { return begin_s + integration_s * (2 * i + 1) / (2.0 * kInstants); }
  double Middle_s() const { return begin_s + 0.5 * integration_s; }
};

class SubFrameTracer {
 public:
  // reuse: flat pixels may be taken from the mid-exposure's.
  SubFrameTracer(const RayScene& scene, const Optics& optics, const MidHits& mid, const BodyMotion& camera,
                 const SubFrame& sub_frame, bool reuse);
  void Row(int row, RowHits& hits) const;

 private:
  void FromPlane(std::size_t pixel, const RayHit& hit, const Eigen::Vector3f& point, RowHits& row,
                 std::size_t at) const;

  const RayScene& scene_;
  const Optics& optics_;
  const MidHits& mid_;
  bool reuse_;
  std::array<Eigen::Matrix3f, SubFrame::kInstants> R_world_camera_;
  std::array<Eigen::Vector3f, SubFrame::kInstants> origin_world_;
};

// The mid-exposure's, for a camera that stands in a scene that stands.
void RowOfMid(const Optics& optics, const MidHits& mid, int row, RowHits& hits);

// How far the picture moves [pixels] within span_s / 2 of mid-exposure, at most, for what is nearest_m away.
double PictureMotion_px(const Optics& optics, const BodyMotion& camera, double span_s, double nearest_m);

}  // namespace merlin::sim
