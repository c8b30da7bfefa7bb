#include "scenarios/judge/alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin {
namespace {

constexpr double kDelta_m = 1.0;
constexpr double kDeltaTolerance_m = 0.1;  // evo's default: a tenth of the delta
// Weight of the orientations against the positions' covariance. Far below any real path's spread: it moves the mean
// square error by less than 1e-8 m2, and decides only what the positions leave open.
constexpr double kOrientationWeight_m2 = 1e-9;

bool AllFinite(std::span<const PosePair> pairs) {
  return std::all_of(pairs.begin(), pairs.end(), [](const PosePair& pair) {
    return pair.T_world_base.matrix().allFinite() && pair.T_map_base.matrix().allFinite();
  });
}

// path_m[i]: length of the true path up to instant i.
std::vector<double> TruePath_m(std::span<const PosePair> pairs) {
  std::vector<double> path_m(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i)
    path_m[i] = path_m[i - 1] + (pairs[i].T_world_base.translation() - pairs[i - 1].T_world_base.translation()).norm();
  return path_m;
}

// The instant after i nearest to kDelta_m further along the path, the first of equals; nothing if none is near enough.
std::optional<std::size_t> Partner(const std::vector<double>& path_m, std::size_t i) {
  const auto at_least = [&path_m, i](double length_m) {
    return std::partition_point(path_m.begin() + i + 1, path_m.end(),
                                [&](double path) { return path - path_m[i] < length_m; });
  };
  const auto error_m = [&path_m, i](auto j) { return std::abs(*j - path_m[i] - kDelta_m); };
  auto best = at_least(kDelta_m);
  if (best != path_m.begin() + i + 1) {
    const auto below = at_least(*(best - 1) - path_m[i]);  // a standing car repeats a length: take its first instant
    if (best == path_m.end() || error_m(below) <= error_m(best)) best = below;
  }
  if (best == path_m.end() || error_m(best) > kDeltaTolerance_m) return std::nullopt;
  return static_cast<std::size_t>(best - path_m.begin());
}

}  // namespace

std::vector<PosePair> PairAtEqualStamps(const Trajectory& truth, const Trajectory& estimate) {
  std::vector<PosePair> pairs;
  auto true_pose = truth.begin();
  for (const StampedPose& pose : estimate) {
    while (true_pose != truth.end() && true_pose->stamp < pose.stamp) ++true_pose;
    if (true_pose == truth.end()) break;
    if (true_pose->stamp == pose.stamp) pairs.push_back({true_pose->T, pose.T});
  }
  return pairs;
}

std::optional<Ate> AlignAndAte(std::span<const PosePair> pairs) {
  if (pairs.empty() || !AllFinite(pairs)) return std::nullopt;
  const double count = static_cast<double>(pairs.size());
  Eigen::Vector3d mean_world = Eigen::Vector3d::Zero(), mean_map = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    mean_world += pair.T_world_base.translation() / count;
    mean_map += pair.T_map_base.translation() / count;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // Umeyama eq. 38
  for (const PosePair& pair : pairs) {
    covariance +=
        (pair.T_world_base.translation() - mean_world) * (pair.T_map_base.translation() - mean_map).transpose() / count;
    covariance += kOrientationWeight_m2 * pair.T_world_base.linear() * pair.T_map_base.linear().transpose() / count;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);  // eq. 39: a rotation, no reflection
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;

  Ate ate;
  ate.T_world_map.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();  // eq. 40
  ate.T_world_map.translation() = mean_world - ate.T_world_map.linear() * mean_map;           // eq. 41
  double sum_m2 = 0.0;
  for (const PosePair& pair : pairs)
    sum_m2 += (pair.T_world_base.translation() - ate.T_world_map * pair.T_map_base.translation()).squaredNorm();
  ate.rmse_m = std::sqrt(sum_m2 / count);
  return ate;
}

std::optional<Rpe> RpeOverOneMetre(std::span<const PosePair> pairs) {
  if (!AllFinite(pairs)) return std::nullopt;
  const std::vector<double> path_m = TruePath_m(pairs);
  Rpe rpe;
  double sum_m2 = 0.0, sum_rad2 = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::optional<std::size_t> j = Partner(path_m, i);
    if (!j) continue;
    const Pose true_motion = pairs[i].T_world_base.inverse() * pairs[*j].T_world_base;
    const Pose motion = pairs[i].T_map_base.inverse() * pairs[*j].T_map_base;
    const Pose error = true_motion.inverse() * motion;
    sum_m2 += error.translation().squaredNorm();
    sum_rad2 += LogSo3(error.linear()).squaredNorm();
    ++rpe.pairs;
  }
  if (rpe.pairs == 0) return std::nullopt;
  const double count = static_cast<double>(rpe.pairs);
  rpe.translation_percent = 100.0 * std::sqrt(sum_m2 / count) / kDelta_m;
  rpe.rotation_deg_per_m = 180.0 / std::numbers::pi * std::sqrt(sum_rad2 / count) / kDelta_m;
  return rpe;
}

double PathLength_m(const Trajectory& trajectory) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    length_m += (trajectory[i].T.translation() - trajectory[i - 1].T.translation()).norm();
  return length_m;
}

}  // namespace merlin
