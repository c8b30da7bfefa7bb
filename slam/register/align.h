// Registration of two free clouds by ICP (P. Besl and N. McKay, "A method for registration of 3-D shapes", PAMI 14,
// 1992), with a choice of three distances between the points of a pair:
//
//   point   between the points; solved by the SVD (slam/register/rigid_fit.h)
//   plane   from the target's surface (Y. Chen and G. Medioni, "Object modelling by registration of multiple range images",
//           Image and Vision Computing 10, 1992)
//   gicp    between two surfaces (A. Segal, D. Haehnel and S. Thrun, "Generalized-ICP", RSS 2009): each point has its sigma
//           across its surface, and a far larger one along it
//
// Plane and gicp weigh pairs by the kernel of Geman and McClure. It is wide at first, so that a bad guess is still
// pulled in. While it narrows, only a part of the source's points is used.
#pragma once

#include "robot/base/config.h"
#include "robot/types/se3.h"
#include "slam/register/cloud.h"
#include "slam/register/undetermined.h"

namespace merlin {

// kAuto: gicp where both clouds have surfaces; else (a curve, a few landmarks, a filled volume) point.
enum class AlignMethod { kPoint, kPlane, kGicp, kAuto };

struct AlignConfig {
  AlignMethod method = AlignMethod::kAuto;
  // [0, 1e9] largest distance of a pair; 0: a twentieth of the target's diagonal, with kPoint a quarter
  double max_distance_m = 0.0;
  int iterations_max = 200;      // [1, 100000]
  double step_converged = 1e-5;  // [0, 1] share of the source's mean size; a smaller step ends the iteration
  int neighbours = 20;           // [3, 1000] that a point's surface is computed from; as in small_gicp
  double overlap_min = 0.1;      // [0, 1] share of the source's points with a pair; below it has not converged; guess
};

template <class Visitor>
void Visit(Visitor& v, AlignConfig& c) {
  v("max_distance_m", c.max_distance_m, {0.0, 1e9});
  v("iterations_max", c.iterations_max, {1.0, 100000.0});
  v("step_converged", c.step_converged, {0.0, 1.0});
  v("neighbours", c.neighbours, {3.0, 1000.0});
  v("overlap_min", c.overlap_min, {0.0, 1.0});
}

enum class AlignEnd { kConverged, kTooFewPairs, kUndetermined, kIterations };

struct AlignResult {
  Pose T_target_source = Pose::Identity();
  // Over (translation, rotation) in the source frame, from the residuals, taken as independent. They are not quite:
  // errors of two sigmas are usual. Zero unless converged.
  Matrix6d covariance = Matrix6d::Zero();
  Undetermined undetermined;    // motions of the source frame that keep the guess; turns are about the centroid
  int inliers = 0;              // source points with a target point within max_distance_m
  double overlap = 0.0;         // their share
  double rms_m = 0.0;           // of their distances, point to point
  double max_distance_m = 0.0;  // as used
  int iterations = 0;
  AlignMethod method = AlignMethod::kAuto;  // as used, if there were points
  AlignEnd end = AlignEnd::kTooFewPairs;
  bool converged() const { return end == AlignEnd::kConverged; }  // false: must not be trusted
};

AlignResult Align(const Cloud& source, const Cloud& target, const Pose& T_target_source_guess,
                  const AlignConfig& config);

}  // namespace merlin
