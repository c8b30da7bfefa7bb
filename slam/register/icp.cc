#include "slam/register/icp.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "slam/map/nearest_search.h"

namespace merlin {
namespace {

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  int pairs = 0, inliers = 0;
  double squares_m2 = 0.0;
};

// A point, with what stays the same in every iteration.
struct Source {
  Eigen::Vector3f position;
  float sigma_m;
  Eigen::Vector3d p_base, ray;
};

std::vector<Source> Prepare(std::span<const Point> points_base, const Eigen::Vector3f& origin_base) {
  std::vector<Source> sources;
  sources.reserve(points_base.size());
  for (const Point& point : points_base) {
    const Eigen::Vector3d p_base = point.position.cast<double>();
    sources.push_back({point.position, point.sigma_m, p_base, (p_base - origin_base.cast<double>()).normalized()});
  }
  return sources;
}

NormalEquations Linearize(std::span<const Source> points, NearestSearch& search, const Pose& T_map_base,
                          const IcpConfig& config) {
  NormalEquations equations;
  const Eigen::Isometry3f T = T_map_base.cast<float>();
  const double kernel_m2 = config.kernel_m * config.kernel_m;
  for (const Source& point : points) {
    const Eigen::Vector3f p_map = T * point.position;
    const Voxel* voxel = search.Nearest(p_map);
    if (voxel == nullptr) continue;
    ++equations.pairs;
    const double residual_m = voxel->normal.dot(p_map - voxel->mean);
    const double squared_m2 = residual_m * residual_m;
    if (squared_m2 < 4.0 * kernel_m2) {
      ++equations.inliers;
      equations.squares_m2 += squared_m2;
    }
    // Range noise acts along the ray: at a grazing angle little of it is normal to the surface.
    const Eigen::Vector3d n_base = (T.linear().transpose() * voxel->normal).cast<double>();
    const double across = n_base.dot(point.ray);
    const double variance_m2 = std::pow(point.sigma_m * across, 2) + config.map_sigma_m * config.map_sigma_m;
    const double robust = std::pow(kernel_m2 / (kernel_m2 + squared_m2), 2);
    const double weight = config.independent_share * robust / variance_m2;
    // d(T Exp(x) p) = R (x_t + x_r x p)
    Vector6d jacobian;
    jacobian << n_base, point.p_base.cross(n_base);
    for (int i = 0; i < 6; ++i) equations.H.col(i) += (weight * jacobian(i)) * jacobian;
    equations.b += weight * residual_m * jacobian;
  }
  equations.H = equations.H.selfadjointView<Eigen::Lower>();
  return equations;
}

double LevelShare(const Matrix6d& H) {
  const Eigen::Matrix2d level = H.topLeftCorner<2, 2>();
  const double half = 0.5 * level.trace();  // the larger eigenvalue of a symmetric 2x2 matrix
  const double best = half + std::sqrt(std::max(0.0, half * half - level.determinant()));
  return best / H(2, 2);
}

}  // namespace

RegisterResult Register(std::span<const Point> points_base, const Eigen::Vector3f& origin_base, const VoxelMap& map,
                        const PosePrior& prior, const IcpConfig& config) {
  RegisterResult result;
  result.T_map_base = prior.T_map_base;
  const std::vector<Source> points = Prepare(points_base, origin_base);
  NearestSearch search(map, points.size());
  bool small_step = false;
  while (result.iterations < config.iterations_max && !small_step) {
    ++result.iterations;
    NormalEquations equations = Linearize(points, search, result.T_map_base, config);
    result.pairs = equations.pairs;
    result.inliers = equations.inliers;
    if (equations.inliers < config.inliers_min) return result;
    result.inlier_share = static_cast<double>(equations.inliers) / equations.pairs;
    result.rms_m = std::sqrt(equations.squares_m2 / equations.inliers);
    result.level_share = LevelShare(equations.H);
    equations.H += prior.information;
    equations.b += prior.information * Log(prior.T_map_base.inverse() * result.T_map_base);
    const Eigen::LDLT<Matrix6d> solver(equations.H);
    const Vector6d step = -solver.solve(equations.b);
    if (solver.info() != Eigen::Success || !step.allFinite()) return result;
    result.T_map_base = result.T_map_base * Exp(step);
    result.covariance = solver.solve(Matrix6d::Identity());
    small_step = step.norm() < config.step_converged;
  }
  result.converged = small_step && result.inlier_share >= config.inlier_share_min;
  return result;
}

}  // namespace merlin
