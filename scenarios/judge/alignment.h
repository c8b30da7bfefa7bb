// Errors of an estimated trajectory against the true one. The definitions are those of the evo package (M. Grupp), so
// that anyone can recompute them from trajectory_truth.tum and trajectory_estimate.tum:
//   evo_ape tum TRUTH ESTIMATE -a [-s]
//   evo_rpe tum TRUTH ESTIMATE --delta 1 --delta_unit m --all_pairs --pairs_from_reference [--pose_relation angle_deg]
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "robot/types/se3.h"
#include "robot/types/trajectory.h"

namespace merlin {

// Truth and estimate at one instant.
struct PosePair {
  Pose T_world_base = Pose::Identity();
  Pose T_map_base = Pose::Identity();
};

// Pairs of poses with equal stamps, to the nanosecond.
std::vector<PosePair> PairAtEqualStamps(const Trajectory& truth, const Trajectory& estimate);

// Statistics as in evo. spread: standard deviation of the population (division by n). median: for an even number of
// errors the mean of the middle two.
struct ErrorStatistics {
  double rmse = 0.0, mean = 0.0, median = 0.0, spread = 0.0, min = 0.0, max = 0.0;
};
ErrorStatistics StatisticsOf(std::vector<double> errors);  // at least one

// Transform fitted to an estimate before the comparison: none, rotation and translation, or also scale.
enum class Alignment { kNone, kSe3, kSim3 };

struct Ate {
  Pose T_world_map = Pose::Identity();
  double scale = 1.0;   // p_world = T_world_map * (scale * p_map)
  double rmse_m = 0.0;  // of positions after the alignment
  ErrorStatistics error_m;
};

// Absolute trajectory error: the alignment minimises sum |p_world - T_world_map (scale p_map)|^2 over the positions (S.
// Umeyama, "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991). Where
// positions do not determine the rotation (one pose, standing, a straight line; evo refuses these) the orientations
// decide. None if there are no pairs, a number is not finite, or the scale is undetermined (an estimate that stands
// still).
std::optional<Ate> AlignAndAte(std::span<const PosePair> pairs, Alignment alignment = Alignment::kSe3);

// Relative pose errors over a distance along the true path. Each instant i is paired with the later instant j whose
// true path length from i is nearest to the distance (the first of equals), if it is within a tenth of the distance.
// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q the truth, P the estimate (J. Sturm et al., "A benchmark for the evaluation of
// RGB-D SLAM systems", IROS 2012), where the positions of P are scaled first. One error of each kind per pair; empty if
// there is no pair or a number is not finite.
struct RelativeErrors {
  std::vector<double> translation_m, rotation_rad;
};
RelativeErrors ErrorsOver(std::span<const PosePair> pairs, double distance_m, double scale = 1.0);

struct Rpe {
  double translation_percent = 0.0;  // rmse of |translation of E| over 1 m
  double rotation_deg_per_m = 0.0;   // rmse of the angle of E over 1 m
  std::size_t pairs = 0;
};

// Rmse of the relative errors over 1 m; none if there are no pairs.
std::optional<Rpe> RpeOverOneMetre(std::span<const PosePair> pairs);

// Length of the path through the positions.
double PathLength_m(const Trajectory& trajectory);

}  // namespace merlin
