#include "scenarios/judge/alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace merlin {
namespace {

constexpr double kDistanceTolerance = 0.1;  // evo's default: a tenth of the distance
// Weight of the orientations relative to the covariance of the positions. It is far below the spread of any real path:
// it changes the mean square error by less than 1e-8 m2, and decides only what the positions do not determine.
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

// The instant after i that is nearest to distance_m further along the path, the first of equals; none if too far off.
std::optional<std::size_t> Partner(const std::vector<double>& path_m, std::size_t i, double distance_m) {
  const auto at_least = [&path_m, i](double length_m) {
    return std::partition_point(path_m.begin() + i + 1, path_m.end(),
                                [&](double path) { return path - path_m[i] < length_m; });
  };
  const auto error_m = [&](auto j) { return std::abs(*j - path_m[i] - distance_m); };
  auto best = at_least(distance_m);
  if (best != path_m.begin() + i + 1) {
    const auto below = at_least(*(best - 1) - path_m[i]);  // a standing car repeats a length: take its first instant
    if (best == path_m.end() || error_m(below) <= error_m(best)) best = below;
  }
  if (best == path_m.end() || error_m(best) > kDistanceTolerance * distance_m) return std::nullopt;
  return static_cast<std::size_t>(best - path_m.begin());
}

struct Umeyama {
  Eigen::Vector3d mean_world = Eigen::Vector3d::Zero(), mean_map = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double variance_map_m2 = 0.0;      // eq. 36
  double covariance_along_m2 = 0.0;  // tr(D S) of eq. 42, from the positions alone
};

Umeyama Align(std::span<const PosePair> pairs) {
  const double count = static_cast<double>(pairs.size());
  Umeyama found;
  for (const PosePair& pair : pairs) {
    found.mean_world += pair.T_world_base.translation() / count;
    found.mean_map += pair.T_map_base.translation() / count;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(), orientations = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d map = pair.T_map_base.translation() - found.mean_map;
    covariance += (pair.T_world_base.translation() - found.mean_world) * map.transpose() / count;  // eq. 38
    found.variance_map_m2 += map.squaredNorm() / count;
    orientations += kOrientationWeight_m2 * pair.T_world_base.linear() * pair.T_map_base.linear().transpose() / count;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance + orientations, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);  // eq. 39: a rotation, no reflection
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
  found.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();  // eq. 40
  found.covariance_along_m2 = (found.rotation.transpose() * covariance).trace();
  return found;
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

ErrorStatistics StatisticsOf(std::vector<double> errors) {
  std::ranges::sort(errors);
  const double count = static_cast<double>(errors.size());
  const std::size_t half = errors.size() / 2;
  ErrorStatistics statistics{.min = errors.front(), .max = errors.back()};
  statistics.median = errors.size() % 2 ? errors[half] : 0.5 * (errors[half - 1] + errors[half]);
  double squares = 0.0, away = 0.0;
  for (const double error : errors) {
    squares += error * error;
    statistics.mean += error / count;
  }
  for (const double error : errors) away += (error - statistics.mean) * (error - statistics.mean);
  statistics.rmse = std::sqrt(squares / count);
  statistics.spread = std::sqrt(away / count);
  return statistics;
}

std::optional<Ate> AlignAndAte(std::span<const PosePair> pairs, Alignment alignment) {
  if (pairs.empty() || !AllFinite(pairs)) return std::nullopt;
  Ate ate;
  if (alignment != Alignment::kNone) {
    const Umeyama found = Align(pairs);
    if (alignment == Alignment::kSim3) {
      if (!(found.variance_map_m2 > 0.0)) return std::nullopt;
      ate.scale = found.covariance_along_m2 / found.variance_map_m2;  // eq. 42
    }
    ate.T_world_map.linear() = found.rotation;
    ate.T_world_map.translation() = found.mean_world - ate.scale * (found.rotation * found.mean_map);  // eq. 41
  }
  std::vector<double> errors_m;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d p_map = ate.scale * pair.T_map_base.translation();
    errors_m.push_back((pair.T_world_base.translation() - ate.T_world_map * p_map).norm());
  }
  ate.error_m = StatisticsOf(std::move(errors_m));
  ate.rmse_m = ate.error_m.rmse;
  return ate;
}

RelativeErrors ErrorsOver(std::span<const PosePair> pairs, double distance_m, double scale) {
  RelativeErrors errors;
  if (!AllFinite(pairs)) return errors;
  const std::vector<double> path_m = TruePath_m(pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::optional<std::size_t> j = Partner(path_m, i, distance_m);
    if (!j) continue;
    const Pose true_motion = pairs[i].T_world_base.inverse() * pairs[*j].T_world_base;
    Pose motion = pairs[i].T_map_base.inverse() * pairs[*j].T_map_base;
    motion.translation() *= scale;
    const Pose error = true_motion.inverse() * motion;
    errors.translation_m.push_back(error.translation().norm());
    errors.rotation_rad.push_back(LogSo3(error.linear()).norm());
  }
  return errors;
}

std::optional<Rpe> RpeOverOneMetre(std::span<const PosePair> pairs) {
  const RelativeErrors errors = ErrorsOver(pairs, 1.0);
  if (errors.translation_m.empty()) return std::nullopt;
  return Rpe{.translation_percent = 100.0 * StatisticsOf(errors.translation_m).rmse,
             .rotation_deg_per_m = 180.0 / std::numbers::pi * StatisticsOf(errors.rotation_rad).rmse,
             .pairs = errors.translation_m.size()};
}

double PathLength_m(const Trajectory& trajectory) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    length_m += (trajectory[i].T.translation() - trajectory[i - 1].T.translation()).norm();
  return length_m;
}

}  // namespace merlin
