// The lens and the lamp of a camera: the directions of its sub-rays (3 x 3 per pixel), and how brightly each direction
// is lit and seen.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "sim/tof/effects.h"

namespace merlin::sim {

constexpr int kSubRaysPerEdge = 3;

// One lamp board, in the optical frame.
struct Board {
  Eigen::Vector3f position{0, 0, 0};
  float share = 1.0f;  // of the light
};

struct Optics {
  Optics(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects);

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  // Index of the s-th sub-ray of a pixel, where s counts row by row. The layout is [row of pixels][s][column of
  // pixels], so that the same sub-ray of neighbouring pixels is contiguous.
  std::size_t SubRay(std::size_t pixel, std::size_t s) const {
    return first_sub_ray[pixel] + s * static_cast<std::size_t>(width);
  }
  std::size_t Middle(std::size_t pixel) const { return SubRay(pixel, static_cast<std::size_t>(per_pixel / 2)); }
  std::size_t PixelOf(std::size_t sub_ray) const {
    const std::size_t w = static_cast<std::size_t>(width), n = static_cast<std::size_t>(per_pixel);
    return sub_ray / (w * n) * w + sub_ray % w;
  }
  Eigen::Vector3f Direction(std::size_t sub_ray) const { return {x[sub_ray], y[sub_ray], z[sub_ray]}; }
  // Relative radiant intensity of the lamp along a direction (slopes x / z, y / z); 1 on the axis.
  double Lobe(double slope_x, double slope_y) const;

  int width, height;
  int per_pixel;                           // sub-rays: 9 or 1
  std::vector<std::size_t> first_sub_ray;  // [pixel]
  std::vector<float> x, y, z;              // [sub-ray] direction: unit, optical frame
  std::vector<float> lens;                 // [pixel] vignetting: cos^4 of the angle to the axis (1 without lamp effect)
  std::vector<float> lit_and_seen;         // [sub-ray] lens times lobe
  std::vector<Board> boards;               // one at the lens, or two beside it
  double tan_half_x, tan_half_y;           // of the field of view
  double lobe_exponent;                    // 0: uniform
  double lamp_reach;                       // how far the lamp shines, in fields of view
};

}  // namespace merlin::sim
