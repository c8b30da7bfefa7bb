#include "robot/types/camera_model.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace merlin {
namespace {

constexpr double kTolerance = 1e-13;       // of the inverse, relative
constexpr double kFoldDeterminant = 0.02;  // a field squeezed to a fiftieth of its area is as good as folded

// d Distort / d xy.
Eigen::Matrix2d Jacobian(const CameraModel& camera, const Eigen::Vector2d& xy) {
  const double x = xy.x(), y = xy.y(), r2 = xy.squaredNorm();
  const double radial = 1.0 + r2 * (camera.k1 + r2 * camera.k2);
  const double slope = 2.0 * (camera.k1 + 2.0 * r2 * camera.k2);  // d radial / d x = slope x
  const double mixed = slope * x * y + 2.0 * camera.p1 * x + 2.0 * camera.p2 * y;
  Eigen::Matrix2d J;
  J << radial + slope * x * x + 2.0 * camera.p1 * y + 6.0 * camera.p2 * x, mixed,  //
      mixed, radial + slope * y * y + 6.0 * camera.p1 * y + 2.0 * camera.p2 * x;
  return J;
}

// Newton's method. Each step is halved until it comes nearer without crossing a fold (determinant 0). Started at the
// axis and moved outwards, the solution therefore stays in the field around the axis.
Eigen::Vector2d Invert(const CameraModel& camera, const Eigen::Vector2d& wanted, Eigen::Vector2d xy) {
  const Eigen::Vector2d none = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector2d missing = wanted - camera.Distort(xy);
  for (int i = 0; i < 100; ++i) {
    Eigen::Vector2d step = Jacobian(camera, xy).inverse() * missing;
    if (step.norm() <= kTolerance * (1.0 + xy.norm())) return xy + step;
    for (int halvings = 0;; ++halvings, step *= 0.5) {
      if (halvings == 40) return none;
      const Eigen::Vector2d left = wanted - camera.Distort(xy + step);
      if (!(left.norm() < missing.norm()) || Jacobian(camera, xy + step).determinant() <= 0.0) continue;
      xy += step;
      missing = left;
      break;
    }
  }
  return none;
}

}  // namespace

Eigen::Vector2d CameraModel::Distort(const Eigen::Vector2d& xy) const {
  const double x = xy.x(), y = xy.y(), r2 = xy.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * k2);
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

Eigen::Vector2d CameraModel::Undistort(const Eigen::Vector2d& distorted_xy) const {
  return Distorts() ? Invert(*this, distorted_xy, Eigen::Vector2d::Zero()) : distorted_xy;
}

Eigen::Vector2d CameraModel::ProjectDistorted(const Eigen::Vector2d& xy) const {
  const Eigen::Vector2d distorted = Distort(xy);
  const bool folded = !(Undistort(distorted) - xy).isZero(1e-9 * (1.0 + xy.norm()));
  if (folded) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return {fx_px * distorted.x() + cx_px, fy_px * distorted.y() + cy_px};
}

// Follows the inverse along straight lines from the axis to points all along the picture's edge. If it is smooth on
// each of them, no two directions share a place, because the lines cover the picture.
bool CameraModel::IsInvertible() const {
  if (!Distorts()) return true;
  constexpr int kPointsPerEdge = 32, kSteps = 64;
  const Eigen::Vector2d upper_left((-0.5 - cx_px) / fx_px, (-0.5 - cy_px) / fy_px);
  const Eigen::Vector2d size(width / fx_px, height / fy_px);
  for (int i = 0; i < 4 * kPointsPerEdge; ++i) {
    const double along = (i / 4) / (kPointsPerEdge - 1.0), far = i % 2;
    const Eigen::Vector2d corner_share = i % 4 < 2 ? Eigen::Vector2d(along, far) : Eigen::Vector2d(far, along);
    const Eigen::Vector2d edge = upper_left + size.cwiseProduct(corner_share);
    Eigen::Vector2d xy = Eigen::Vector2d::Zero();
    for (int step = 1; step <= kSteps; ++step) {
      xy = Invert(*this, edge * (static_cast<double>(step) / kSteps), xy);
      if (!(Jacobian(*this, xy).determinant() > kFoldDeterminant)) return false;
    }
    if (!(Undistort(edge) - xy).isZero(1e-9 * (1.0 + xy.norm()))) return false;
  }
  return true;
}

}  // namespace merlin
