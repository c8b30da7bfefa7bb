// What the sub-rays of a frame meet: all of them at mid-exposure, then again in every sub-frame as camera and bodies
// move.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/rays/ray_scene.h"
#include "sim/tof/sub_grid.h"
#include "sim/world/motion.h"

namespace merlin::sim {

// At mid-exposure, of every sub-ray.
struct MidHits {
  explicit MidHits(const Optics& optics) : grid(optics) {}
  Pose T_world_camera;
  SubGrid grid;
  std::vector<Ray> rays;            // [sub-ray], world
  std::vector<RayHit> hits;         // the same
  std::vector<std::uint8_t> mixed;  // [pixel] its sub-rays do not all meet one plane of one geom

  Eigen::Vector3f Point(std::size_t i) const { return rays[i].origin + hits[i].range_m * rays[i].direction; }
};
// Every second sub-ray is traced, as on a chessboard; one whose neighbours all meet one plane meets it, too. What is
// thinner than a sub-ray may so be missed half of the times.
MidHits TraceMid(const RayScene& scene, const Optics& optics, const Pose& T_world_camera, int threads);

// Of the sub-rays of one row of pixels in one sub-frame; vectors in the optical frame of the sub-ray's own instant.
struct RowHits {
  std::vector<float> range_m;  // negative: nothing
  std::vector<float> normal_x, normal_y, normal_z;
  std::vector<int> geom;
  void Resize(std::size_t n);
};

// Those of them that are traced.
struct RowRays {
  std::vector<Ray> rays;
  std::vector<RayHit> hits;
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

// What the sub-frames need not trace: sub-rays that in the mid-exposure are far enough from any edge are taken from their
// plane.
struct FramePlan {
  struct Stretch {
    std::size_t begin, end;  // in the row: neighbours with one instant and one face
    int face, geom;
  };
  struct Row {
    std::vector<Stretch> calm;
    std::vector<std::size_t> traced;  // in the row, pixel by pixel: their rays go close together
  };
  std::vector<Row> rows;
  std::vector<int> faces;  // that calm ones see
};
// calm: [sub-ray]; empty: none is.
FramePlan PlanFrame(const Optics& optics, const MidHits& mid, std::span<const std::uint8_t> calm);

class SubFrameTracer {
 public:
  SubFrameTracer(const RayScene& scene, const Optics& optics, const FramePlan& plan, const BodyMotion& camera,
                 const SubFrame& sub_frame);
  // rays: room to work in.
  void Row(int row, RowHits& hits, RowRays& rays) const;

 private:
  // A face as seen at one instant: normal in the optical frame, towards the lens, and the lens' distance from the plane.
  struct SeenFace {
    Eigen::Vector3f normal_camera{0, 0, 0};
    float distance_m = 0.0f;
  };

  void FromPlane(const FramePlan::Stretch& stretch, const SeenFace& face, std::size_t first, RowHits& row) const;

  const RayScene& scene_;
  const Optics& optics_;
  const FramePlan& plan_;
  std::array<Eigen::Matrix3f, SubFrame::kInstants> R_world_camera_;
  std::array<Eigen::Vector3f, SubFrame::kInstants> origin_world_;
  std::vector<std::array<SeenFace, SubFrame::kInstants>> seen_;  // [face], of those that calm sub-rays see
};

// The mid-exposure's, for a camera that stands in a scene that stands.
void RowOfMid(const Optics& optics, const MidHits& mid, int row, RowHits& hits);

// How far the picture of this moves [pixels] within span_s / 2 of mid-exposure, at most; 0 for what cannot get into it.
double PictureMotion_px(const Optics& optics, const RayScene& scene, const MidHits& mid, const Mover& mover,
                        double span_s);

// How far the picture moves [pixels] within span_s / 2 of mid-exposure, at most, for what is nearest_m away.
double PictureMotion_px(const Optics& optics, const BodyMotion& camera, double span_s, double nearest_m);

}  // namespace merlin::sim
