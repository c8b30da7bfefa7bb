// Finds what each sub-ray of a frame hits. All of them are traced once, at mid-exposure. In the other sub-frames the
// camera and the bodies have moved slightly: a sub-ray that hit a plane far from any edge still hits the same plane, so
// that its range is computed directly. Only the rest are traced again.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/rays/ray_scene.h"
#include "sim/tof/sub_grid.h"
#include "sim/world/motion.h"

namespace merlin::sim {

// Every sub-ray at mid-exposure.
struct MidHits {
  explicit MidHits(const Optics& optics) : grid(optics) {}
  Pose T_world_camera;
  SubGrid grid;
  std::vector<Ray> rays;            // [sub-ray], world
  std::vector<RayHit> hits;         // the same
  std::vector<std::uint8_t> mixed;  // [pixel] its sub-rays do not all hit one plane of one geom

  Eigen::Vector3f Point(std::size_t i) const { return rays[i].origin + hits[i].range_m * rays[i].direction; }
};
// Every second sub-ray is traced, in a chessboard pattern. A sub-ray between traced ones that all hit one plane is
// assumed to hit it as well, so objects thinner than a sub-ray are missed half of the time.
MidHits TraceMid(const RayScene& scene, const Optics& optics, const Pose& T_world_camera, int threads);

// What the sub-rays of one row of pixels hit in one sub-frame. Vectors are in the optical frame at the instant of the
// sub-ray.
struct RowHits {
  std::vector<float> range_m;  // negative: nothing
  std::vector<float> normal_x, normal_y, normal_z;
  std::vector<int> geom;
  void Resize(std::size_t n);
};

// The traced rays among them.
struct RowRays {
  std::vector<Ray> rays;
  std::vector<RayHit> hits;
};

// The time of a sub-frame. Its integration is divided into three instants, and sub-ray (i, j) of a pixel uses number (i
// + j) mod 3. This blurs edges that a moving camera passes without more rays. Bodies are at their poses at the middle
// of the sub-frame.
struct SubFrame {
  double begin_s = 0.0;  // from mid-exposure
  double integration_s = 0.0;
  static constexpr int kInstants = 3;
  double Instant_s(int i) const { return begin_s + integration_s * (2 * i + 1) / (2.0 * kInstants); }
  double Middle_s() const { return begin_s + 0.5 * integration_s; }
};

// Which sub-rays take their range from a known plane in the sub-frames ("calm": far enough from any edge at
// mid-exposure), and which are traced.
struct FramePlan {
  struct Stretch {
    std::size_t begin, end;  // range in the row: neighbours with the same instant and face
    int face, geom;
  };
  struct Row {
    std::vector<Stretch> calm;
    std::vector<std::size_t> traced;  // in the row, pixel by pixel, so that packets hold similar rays
  };
  std::vector<Row> rows;
  std::vector<int> faces;  // of calm sub-rays
};
// calm: [sub-ray]; empty: none is.
FramePlan PlanFrame(const Optics& optics, const MidHits& mid, std::span<const std::uint8_t> calm);

class SubFrameTracer {
 public:
  SubFrameTracer(const RayScene& scene, const Optics& optics, const FramePlan& plan, const BodyMotion& camera,
                 const SubFrame& sub_frame);
  // rays: scratch buffers.
  void Row(int row, RowHits& hits, RowRays& rays) const;

 private:
  // A face as seen at one instant: normal in the optical frame, towards the lens, and the lens' distance from the
  // plane.
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

// The hits at mid-exposure, which hold for every sub-frame if neither the camera nor anything in the scene moves.
void RowOfMid(const Optics& optics, const MidHits& mid, int row, RowHits& hits);

// Upper bound for the motion of this mover in the image [pixels] within span_s / 2 of mid-exposure; 0 if it cannot get
// into the image.
double PictureMotion_px(const Optics& optics, const RayScene& scene, const MidHits& mid, const Mover& mover,
                        double span_s);

// Upper bound for the motion in the image [pixels] of things at nearest_m or more within span_s / 2 of mid-exposure.
double PictureMotion_px(const Optics& optics, const BodyMotion& camera, double span_s, double nearest_m);

}  // namespace merlin::sim
