// The pinhole camera with OpenCV's lens distortion, and its pixel convention: (0, 0) is the centre of the upper left pixel.
#pragma once

#include <Eigen/Core>

namespace merlin {

// Optical frame: z forward, x right, y down (REP 103). Focal lengths and principal point in pixels.
struct CameraModel {
  int width = 0;
  int height = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0;  // OpenCV's first four distortion coefficients

  // Unit vector of pixel (u, v) in the optical frame. Distortion is not inverted: valid for k = p = 0.
  Eigen::Vector3d Ray(double u, double v) const {
    return Eigen::Vector3d((u - cx_px) / fx_px, (v - cy_px) / fy_px, 1.0).normalized();
  }
  // Pixel of a point in the optical frame, distortion not applied; z > 0.
  Eigen::Vector2d Project(const Eigen::Vector3d& point_optical) const {
    return {fx_px * point_optical.x() / point_optical.z() + cx_px, fy_px * point_optical.y() / point_optical.z() + cy_px};
  }
};

}  // namespace merlin
