// Turns a range image into points of the base frame with their uncertainty, and keeps what the pixels without a point
// say: free space, something too close, or nothing.
#pragma once

#include <vector>

#include "perception/filter/depth_filter.h"
#include "perception/observation.h"
#include "robot/types/depth_camera.h"
#include "robot/types/se3.h"

namespace merlin {

// One standard deviation of a range [m], from the pixel's amplitude: the small-error law of the two-tap, four-phase
// estimator, c / (4 sqrt2 pi f) sqrt(N_s + 2 sigma_r^2) / (C N_s) with C N_s = amplitude (R. Lange, "3D time-of-flight
// distance measurement with custom solid-state image sensors", thesis, University of Siegen, 2000).
class RangeSigma {
 public:
  RangeSigma(const DepthCameraSheet& sheet, const DepthSettings& settings);
  double Of_m(double amplitude_e) const;

 private:
  double scale_m_, contrast_, noise_e2_;
};

// Unit rays of all pixels in the optical frame, row by row.
std::vector<Eigen::Vector3f> PixelRays(const CameraModel& camera);

// How far a camera sees from its optical axis.
struct FieldOfView {
  double half_rad = 0.0, half_up_rad = 0.0;  // to the nearer side, and up or down, whichever is nearer
};
FieldOfView FieldOfViewOf(const CameraModel& camera);

// The range [m] up to which a dark pixel shows free space: anything nearer with albedo times cos(incidence) >= 0.02
// (black plastic at 60 deg) would have returned more light. At most the unambiguous range.
class FreeRange {
 public:
  FreeRange(const DepthCameraSheet& sheet, const DepthSettings& settings);
  double Of_m(double amplitude_e) const;

 private:
  double darkest_e_m2_, least_e_, farthest_m_;
};

// Fills the observation's points and rays: an accepted pixel becomes a point; one that is too dark, or a ghost, the end
// of its free range; all others directions.
void ProjectDepth(const FilteredDepth& depth, const DepthCameraSheet& sheet, const std::vector<Eigen::Vector3f>& rays,
                  const Pose& T_base_camera, Observation& observation);

}  // namespace merlin
