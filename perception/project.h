// From range image to points with their uncertainty.
#pragma once

#include <vector>

#include "perception/filter/depth_filter.h"
#include "perception/observation.h"
#include "robot/types/depth_camera.h"
#include "robot/types/se3.h"

namespace merlin {

// One sigma of a range [m] from the pixel's amplitude: small-error law of the two-tap, four-phase estimator,
// c / (4 sqrt2 pi f) sqrt(N_s + 2 sigma_r^2) / (C N_s) with C N_s = amplitude (R. Lange, thesis, Siegen 2000).
class RangeSigma {
 public:
  RangeSigma(const DepthCameraSheet& sheet, const DepthSettings& settings);
  double Of_m(double amplitude_e) const;

 private:
  double scale_m_, contrast_, noise_e2_;
};

// Unit rays of all pixels in the optical frame, row-major.
std::vector<Eigen::Vector3f> PixelRays(const CameraModel& camera);

// How far [m] a pixel of so little amplitude is free at least: anything of albedo times cos(incidence) >= 0.02 (black
// plastic's at 60 deg) that stood nearer would have returned more. At most the unambiguous range.
class FreeRange {
 public:
  FreeRange(const DepthCameraSheet& sheet, const DepthSettings& settings);
  double Of_m(double amplitude_e) const;

 private:
  double darkest_e_m2_, least_e_, farthest_m_;
};

// Accepted pixels as points in the base frame; those too dark, or dark enough to be ghosts, as the way that is free before
// them; all others as directions.
void ProjectDepth(const FilteredDepth& depth, const DepthCameraSheet& sheet, const std::vector<Eigen::Vector3f>& rays,
                  const Pose& T_base_camera, Observation& observation);

}  // namespace merlin
