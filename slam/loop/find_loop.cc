#include "slam/loop/find_loop.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "slam/map/voxel_map.h"

namespace merlin {
namespace {

constexpr std::size_t kFormerMax = 15;       // key frames in the former map: every second of the nearest...
constexpr std::size_t kFormerSweepMax = 60;  // ...but all of them where the camera sweeps
constexpr double kThin_m = 0.08;             // each of them gives one point per voxel of this edge
constexpr double kCoarse_m = 0.4, kFine_m = 0.1;
constexpr int kIterations = 30;
constexpr double kSigmas = 3.0;  // of the start: farther away a fit is not believed
constexpr double kStep = 2e-3;   // m and rad; alternating pairs keep a fit from converging more finely

// Indices of key frames of earlier visits that see the same place, nearest view first.
std::vector<std::size_t> FormerViews(std::span<const Keyframe> keyframes, const Pose& T_map_base, double path_m,
                                     const LoopConfig& config) {
  const Eigen::Vector2d centre = ViewCentre(T_map_base);
  std::vector<std::pair<double, std::size_t>> views;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const double since_m = path_m - keyframes[i].path_m;
    if (since_m < config.apart_m) break;
    const double distance_m = (ViewCentre(keyframes[i].T_map_base) - centre).norm();
    const double turn_rad = std::abs(WrapPi(Yaw(keyframes[i].T_map_base) - Yaw(T_map_base)));
    if (distance_m < config.reach_m + config.reach_share * since_m && turn_rad < config.turn_rad)
      views.emplace_back(distance_m, i);
  }
  std::ranges::sort(views);
  const bool sweeps = std::ranges::any_of(keyframes, [](const Keyframe& k) { return k.view_yaw_rad != 0.0; });
  const std::size_t most = sweeps ? kFormerSweepMax : kFormerMax, apart = sweeps ? 1 : 2;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < views.size() && indices.size() < most; i += apart) indices.push_back(views[i].second);
  return indices;
}

// Adds the key frames to a fine map and a coarse one.
void AddTo(VoxelMap& fine, VoxelMap& coarse, std::span<const Keyframe> keyframes,
           std::span<const std::size_t> indices) {
  std::vector<std::vector<Point>> thin;
  for (const std::size_t i : indices) thin.push_back(Downsample(keyframes[i].points_base, kThin_m));
  std::vector<PlacedPoints> views;
  for (std::size_t k = 0; k < indices.size(); ++k) views.push_back({thin[k], keyframes[indices[k]].T_map_base});
  fine.InsertAll(views, 0.0);
  coarse.InsertAll(views, 0.0);
}

double ShareMeeting(const VoxelMap& map, std::span<const Point> points_base, const Pose& T_map_base) {
  if (points_base.empty()) return 0.0;
  const Eigen::Isometry3f T = T_map_base.cast<float>();
  const auto meets = [&](const Point& point) { return map.Nearest(T * point.position) != nullptr; };
  return static_cast<double>(std::ranges::count_if(points_base, meets)) / static_cast<double>(points_base.size());
}

}  // namespace

PlaceFit FitToViews(std::span<const Keyframe> keyframes, std::span<const std::size_t> views,
                    std::span<const Point> points_base, const Pose& T_map_base, const LoopConfig& config) {
  PosePrior prior;
  prior.T_map_base = T_map_base;
  Vector6d sigma;
  sigma << config.start_sigma_m, config.start_sigma_m, 0.01, 0.005, 0.005, config.start_sigma_rad;
  prior.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  // Coarse first: there a point finds its surface from as far away as a voxel's edge.
  VoxelMap coarse({.voxel_m = kCoarse_m}), fine({.voxel_m = kFine_m});
  AddTo(fine, coarse, keyframes, views);
  const IcpConfig wide{.iterations_max = kIterations,
                       .step_converged = kStep,
                       .kernel_m = 0.5 * kCoarse_m,
                       .map_sigma_m = 0.1 * kCoarse_m};
  const IcpConfig narrow{.iterations_max = kIterations, .step_converged = kStep};
  const RegisterResult guess = Register(points_base, Eigen::Vector3f::Zero(), coarse, prior, wide);
  if (guess.inliers < wide.inliers_min) return {};  // it need not have converged
  prior.information /= 4.0;                         // from here on the shape decides
  const PosePrior refined{guess.T_map_base, Matrix6d(prior.information)};
  PlaceFit result{.fit = Register(points_base, Eigen::Vector3f::Zero(), fine, refined, narrow)};
  if (!result.fit.converged) return result;
  const Eigen::Matrix2d covariance_m2 = result.fit.covariance.topLeftCorner<2, 2>();
  result.sigma_m = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance_m2).eigenvalues().maxCoeff());
  result.near = ShareMeeting(coarse, points_base, result.fit.T_map_base);
  result.on_surface = ShareMeeting(fine, points_base, result.fit.T_map_base);
  return result;
}

bool Fits(const PlaceFit& fit, const LoopConfig& config) {
  return fit.fit.converged && fit.fit.rms_m <= config.rms_max_m && fit.near >= config.overlap_min &&
         fit.on_surface >= config.on_surface_min * fit.near;
}

std::optional<Loop> FindLoop(std::span<const Keyframe> keyframes, std::span<const Point> points_base,
                             const Pose& T_map_base, double path_m, const LoopConfig& config) {
  const std::vector<std::size_t> former = FormerViews(keyframes, T_map_base, path_m, config);
  if (former.empty()) return std::nullopt;
  const PlaceFit fit = FitToViews(keyframes, former, points_base, T_map_base, config);
  if (!Fits(fit, config) || fit.sigma_m > config.sigma_max_m) return std::nullopt;
  // Shapes that are alike attract registration too. Beyond what it may correct, the place must be searched
  // (slam/loop/find_place.h).
  const Pose moved = T_map_base.inverse() * fit.fit.T_map_base;
  if (moved.translation().head<2>().norm() > kSigmas * config.start_sigma_m ||
      std::abs(Yaw(moved)) > kSigmas * config.start_sigma_rad)
    return std::nullopt;
  return Loop{former.front(), fit.fit.T_map_base, fit.fit.covariance, fit.near};
}

}  // namespace merlin
