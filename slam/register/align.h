// Registration of two free clouds: ICP (Besl and McKay 1992), with three ways to measure a pair. Point: the thesis' SVD
// step (eq. 5.18-5.37). Plane: distance from the target's surface (Chen and Medioni 1992). Gicp: between two surfaces
// (Segal, Haehnel and Thrun 2009), each point as uncertain across its surface as its sigma says, and far more along it.
// Plane and gicp weigh pairs by Geman and McClure's kernel, wide at first so that what lies askew still pulls; while it
// narrows, a part of the source's points serves.
#pragma once

#include "robot/base/config.h"
#include "robot/types/se3.h"
#include "slam/register/cloud.h"
#include "slam/register/undetermined.h"

namespace merlin {

// kAuto: gicp where both clouds have surfaces, else (a curve, a few landmarks, a full volume) point.
enum class AlignMethod { kPoint, kPlane, kGicp, kAuto };

struct AlignConfig {
  AlignMethod method = AlignMethod::kAuto;
  // [0, 1e9] points farther apart are no pair; 0: of the target's diagonal a twentieth, with kPoint a quarter
  double max_distance_m = 0.0;
  int iterations_max = 200;      // [1, 100000]
  double step_converged = 1e-5;  // [0, 1] of the source's mean size: a smaller step ends it
  int neighbours = 20;           // [3, 1000] whose spread gives a point its surface; as small_gicp has it
  double overlap_min = 0.1;      // [0, 1] of the source's points with a pair, below: not converged; guess
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
  // Over (translation, rotation) in the source frame, from the pairs' scatter, taken as independent. They are not
  // quite: errors of two of its sigmas are usual. Zero unless converged.
  Matrix6d covariance = Matrix6d::Zero();
  Undetermined undetermined;    // in the source frame; along these the guess is kept, turns being about the centroid
  int inliers = 0;              // source points with a target point within max_distance_m
  double overlap = 0.0;         // their share
  double rms_m = 0.0;           // of their distances, point to point
  double max_distance_m = 0.0;  // as used
  int iterations = 0;
  AlignMethod method = AlignMethod::kAuto;  // as used, if there were points
  AlignEnd end = AlignEnd::kTooFewPairs;
  bool converged() const { return end == AlignEnd::kConverged; }  // false: not to be trusted
};

AlignResult Align(const Cloud& source, const Cloud& target, const Pose& T_target_source_guess,
                  const AlignConfig& config);

}  // namespace merlin
