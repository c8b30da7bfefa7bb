// How far an estimated path lies from the true one. The figures are those of the evo package (M. Grupp), so that anyone
// can recompute them from trajectory_truth.tum and trajectory_estimate.tum:
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

// The instants both have, by equal stamps to the nanosecond.
std::vector<PosePair> PairAtEqualStamps(const Trajectory& truth, const Trajectory& estimate);

// Of many errors, as evo counts them. spread: standard deviation of all of them, not of a sample; median: of an even
// number the mean of the middle two.
struct ErrorStatistics {
  double rmse = 0.0, mean = 0.0, median = 0.0, spread = 0.0, min = 0.0, max = 0.0;
};
ErrorStatistics StatisticsOf(std::vector<double> errors);  // of at least one

// What may be done to an estimate before it is compared: nothing, turn and shift, or turn, shift and scale.
enum class Alignment { kNone, kSe3, kSim3 };

struct Ate {
  Pose T_world_map = Pose::Identity();
  double scale = 1.0;   // p_world = T_world_map * (scale * p_map)
  double rmse_m = 0.0;  // of positions, after that alignment
  ErrorStatistics error_m;
};

// Absolute trajectory error: the alignment minimises sum |p_world - T_world_map (scale p_map)|^2 over the positions (S.
// Umeyama, "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991). Where
// positions leave the rotation open (one pose, standing, a straight line; evo refuses these) the orientations decide.
// Nothing for no pairs, a number that is not finite, or a scale that nothing tells (an estimate that stands).
std::optional<Ate> AlignAndAte(std::span<const PosePair> pairs, Alignment alignment = Alignment::kSe3);

// Relative pose errors over a distance along the true path: each instant i is paired with the later instant j whose path
// length from i along the truth is nearest to the distance (the first of equals), unless that is off by more than a tenth.
// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q the truth, P the estimate (J. Sturm et al., "A benchmark for the evaluation of RGB-D
// SLAM systems", IROS 2012), whose positions are scaled first. One of each a pair; empty where no pair exists or a number
// is not finite.
struct RelativeErrors {
  std::vector<double> translation_m, rotation_rad;
};
RelativeErrors ErrorsOver(std::span<const PosePair> pairs, double distance_m, double scale = 1.0);

struct Rpe {
  double translation_percent = 0.0;  // rmse of |translation of E| over 1 m
  double rotation_deg_per_m = 0.0;   // rmse of the angle of E over 1 m
  std::size_t pairs = 0;
};

// Those over 1 m; nothing where there are none.
std::optional<Rpe> RpeOverOneMetre(std::span<const PosePair> pairs);

// Length of the path through the positions.
double PathLength_m(const Trajectory& trajectory);

}  // namespace merlin
