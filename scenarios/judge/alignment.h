// How far an estimated path lies from the true one. The figures are those of the evo package (M. Grupp), so that anyone
// can recompute them from trajectory_truth.tum and trajectory_estimate.tum:
//   evo_ape tum TRUTH ESTIMATE -a
//   evo_rpe tum TRUTH ESTIMATE --delta 1 --delta_unit m --all_pairs --pairs_from_reference [--pose_relation angle_deg]
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "robot/types/se3.h"
#include "scenarios/judge/trajectory.h"

namespace merlin {

// Truth and estimate at one instant.
struct PosePair {
  Pose T_world_base = Pose::Identity();
  Pose T_map_base = Pose::Identity();
};

// The instants both have, by equal stamps to the nanosecond.
std::vector<PosePair> PairAtEqualStamps(const Trajectory& truth, const Trajectory& estimate);

struct Ate {
  Pose T_world_map = Pose::Identity();  // turn and shift, never scale
  double rmse_m = 0.0;                  // of positions, after that alignment
};

// Absolute trajectory error: T_world_map minimises sum |p_world - T_world_map p_map|^2 over the positions (S. Umeyama,
// "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991, without scale). Where
// positions leave the rotation open (one pose, standing, a straight line; evo refuses these) the orientations decide.
// Nothing for no pairs or a number that is not finite.
std::optional<Ate> AlignAndAte(std::span<const PosePair> pairs);

struct Rpe {
  double translation_percent = 0.0;  // rmse of |translation of E| over 1 m
  double rotation_deg_per_m = 0.0;   // rmse of the angle of E over 1 m
  std::size_t pairs = 0;
};

// Relative pose error over 1 m of the true path: each instant i is paired with the later instant j whose path length
// from i along the truth is nearest to 1 m (the first of equals), unless that is off by more than 0.1 m. E = (Q_i^-1
// Q_j)^-1 (P_i^-1 P_j), Q the truth, P the estimate (J. Sturm et al., "A benchmark for the evaluation of RGB-D SLAM
// systems", IROS 2012). Nothing where no pair exists or a number is not finite.
std::optional<Rpe> RpeOverOneMetre(std::span<const PosePair> pairs);

// Length of the path through the positions.
double PathLength_m(const Trajectory& trajectory);

}  // namespace merlin
