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

  bool Distorts() const { return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0; }

  // The place on the plane z = 1 where the lens puts the direction (x / z, y / z) (D. C. Brown, "Decentering distortion
  // of lenses", 1966, as OpenCV's calib3d writes it).
  Eigen::Vector2d Distort(const Eigen::Vector2d& xy) const;
  // The inverse of Distort, to 1e-12: the direction that the lens puts at this place. If there are several, the one in
  // the field around the axis; NaN if none of them is.
  Eigen::Vector2d Undistort(const Eigen::Vector2d& distorted_xy) const;
  // Whether every place of the picture, up to the outer edges of its pixels, belongs to exactly one direction. A lens
  // model may fold over: beyond some angle it maps back into the picture.
  bool IsInvertible() const;

  // Unit vector of pixel (u, v) in the optical frame. NaN where the lens model folds over.
  Eigen::Vector3d Ray(double u, double v) const {
    Eigen::Vector2d xy((u - cx_px) / fx_px, (v - cy_px) / fy_px);
    if (Distorts()) xy = Undistort(xy);
    return Eigen::Vector3d(xy.x(), xy.y(), 1.0).normalized();
  }
  // Pixel of a point in the optical frame; z > 0. NaN beyond the angle at which the lens model folds over.
  Eigen::Vector2d Project(const Eigen::Vector3d& point_optical) const {
    if (!Distorts())
      return {fx_px * point_optical.x() / point_optical.z() + cx_px,
              fy_px * point_optical.y() / point_optical.z() + cy_px};
    return ProjectDistorted(point_optical.head<2>() / point_optical.z());
  }

 private:
  Eigen::Vector2d ProjectDistorted(const Eigen::Vector2d& xy) const;
};

}  // namespace merlin
