#include "slam/register/align.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "slam/register/neighbours.h"
#include "slam/register/normals.h"
#include "slam/register/rigid_fit.h"
#include "slam/register/tracked_neighbours.h"

namespace merlin {
namespace {

constexpr std::size_t kPairsMin = 3;
// Variance of a surface point across its surface, over that along it; Segal et al. take the same.
constexpr double kAcrossShare = 1e-3;
// The kernel, at which a pair's weight is a quarter, is this many median residuals wide (2 sigma of a normal
// distribution), and at least a tenth of a sigma. It starts at max_distance_m and narrows by a factor per iteration.
// With 3 sigma the parts that two real frames do not share pulled them 60 mm off; with 2 sigma 24 mm.
constexpr double kKernelMedians = 2.0 * 1.4826, kKernelSigmasMin = 0.1, kNarrowing = 0.7;
// Shares of the target's diagonal; 0.4 m in a room of 8 m. With a tenth the same frames ended 41 mm off. The point
// method has no kernel, and needs more.
constexpr double kMaxDistanceShare = 0.05, kMaxDistanceSharePoint = 0.25;
// A cloud with fewer points, or a smaller share of them on surfaces, counts as having no surfaces.
constexpr std::size_t kSurfacePointsMin = 100;
constexpr double kSurfaceShareMin = 0.5;
// While the kernel narrows, about this many of the source's points, evenly spread, are as good as all. They are used
// until a step is shorter than this share of the source's mean size.
constexpr std::size_t kCoarsePoints = 1500;
constexpr double kCoarseStep = 1e-3;
constexpr int kCoarseIterationsMax = 40;
// Pairs that alternate can make the pose circle around the solution. After this many iterations a step against the
// former one is halved, down to the least share.
constexpr int kDampingAfter = 50;
constexpr double kDampingMin = 0.125;

struct Pair {
  Eigen::Vector3d source, target;  // in the source frame
  Eigen::Matrix3d information;     // of target - source
};

// Both clouds relative to their centroids, where all sums are well conditioned.
struct Problem {
  Problem(const Cloud& source_cloud, const Cloud& target_cloud, const AlignConfig& c)
      : config(c),
        source_centroid(Centroid(source_cloud)),
        target_centroid(Centroid(target_cloud)),
        source(About(source_centroid, source_cloud)),
        target(About(target_centroid, target_cloud)),
        target_tree(target.positions) {
    const bool few = std::min(source.size(), target.size()) < kSurfacePointsMin;
    if (c.method == AlignMethod::kAuto && few) config.method = AlignMethod::kPoint;
    if (config.method == AlignMethod::kPoint) return;
    target_surfaces = FindSurfaces(target, target_tree, c.neighbours);
    if (config.method == AlignMethod::kPlane) return;
    source_surfaces = FindSurfaces(source, Neighbours(source.positions), c.neighbours);
    const double share = std::min(source_surfaces.share, target_surfaces.share);
    if (c.method == AlignMethod::kAuto)
      config.method = share >= kSurfaceShareMin ? AlignMethod::kGicp : AlignMethod::kPoint;
  }

  static Cloud About(const Eigen::Vector3d& centroid, Cloud cloud) {
    for (Eigen::Vector3d& position : cloud.positions) position -= centroid;
    return cloud;
  }

  AlignConfig config;
  Eigen::Vector3d source_centroid, target_centroid;
  Cloud source, target;
  Neighbours target_tree;
  Surfaces source_surfaces, target_surfaces;
};

// The mean size: root mean square distance from the centroid.
double Size_m(const Cloud& cloud) {
  double squares_m2 = 0.0;
  for (const Eigen::Vector3d& position : cloud.positions) squares_m2 += position.squaredNorm();
  return std::sqrt(squares_m2 / static_cast<double>(cloud.size()));
}

// Of a point on a surface: its sigma across the surface, far more along it.
Eigen::Matrix3d Covariance(const Eigen::Vector3d& normal, double sigma_m) {
  const Eigen::Matrix3d across = normal * normal.transpose();
  return sigma_m * sigma_m * (across + (Eigen::Matrix3d::Identity() - across) / kAcrossShare);
}

// In the source frame; zero for a point without the surface that the method needs.
Eigen::Matrix3d Information(const Problem& p, const Eigen::Matrix3d& R_source_target, std::size_t i, std::size_t j) {
  const double source_sigma_m = p.source.Sigma_m(i), target_sigma_m = p.target.Sigma_m(j);
  const double variance_m2 = source_sigma_m * source_sigma_m + target_sigma_m * target_sigma_m;
  if (p.config.method == AlignMethod::kPoint) return Eigen::Matrix3d::Identity() / variance_m2;
  const Eigen::Vector3d target_normal = R_source_target * p.target_surfaces.normals[j];
  if (target_normal.isZero()) return Eigen::Matrix3d::Zero();
  if (p.config.method == AlignMethod::kPlane) return target_normal * target_normal.transpose() / variance_m2;
  if (p.source_surfaces.normals[i].isZero()) return Eigen::Matrix3d::Zero();
  return (Covariance(p.source_surfaces.normals[i], source_sigma_m) + Covariance(target_normal, target_sigma_m))
      .inverse();
}

// The pairs of every stride-th source point.
std::vector<Pair> FindPairs(const Problem& p, const Pose& T_target_source, std::size_t stride,
                            TrackedNeighbours& targets, AlignResult& result) {
  std::vector<Pair> pairs;
  pairs.reserve(p.source.size() / stride + 1);
  const Pose T_source_target = T_target_source.inverse();
  const Eigen::Matrix3d R_source_target = T_source_target.linear();
  double squares_m2 = 0.0, asked = 0.0;
  result.inliers = 0;
  for (std::size_t i = 0; i < p.source.size(); i += stride, ++asked) {
    const auto nearest = targets.Nearest(i, T_target_source * p.source.positions[i]);
    if (!nearest) continue;
    ++result.inliers;
    squares_m2 += nearest->squared_m2;
    const Eigen::Matrix3d information = Information(p, R_source_target, i, nearest->index);
    if (information.isZero(0.0)) continue;
    pairs.push_back({p.source.positions[i], T_source_target * p.target.positions[nearest->index], information});
  }
  result.overlap = result.inliers / asked;
  result.rms_m = result.inliers > 0 ? std::sqrt(squares_m2 / result.inliers) : 0.0;
  return pairs;
}

// In units of sigma.
double Residual(const Pair& pair) {
  const Eigen::Vector3d e = pair.target - pair.source;
  return std::sqrt(std::max(0.0, e.dot(pair.information * e)));
}

// Multiplies the pairs' information by the weights of Geman and McClure's kernel, no narrower than `least` sigmas. True
// where the kernel is as narrow as the residuals ask for.
bool Soften(std::vector<Pair>& pairs, double least) {
  std::vector<double> residuals(pairs.size());
  std::ranges::transform(pairs, residuals.begin(), Residual);
  std::vector<double> sorted = residuals;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  const double wanted = std::max(kKernelMedians * *middle, kKernelSigmasMin), kernel = std::max(wanted, least);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double share = kernel * kernel / (kernel * kernel + residuals[i] * residuals[i]);
    pairs[i].information *= share * share;
  }
  return least <= wanted;
}

struct Expansion {
  PairSums sums;
  Vector6d gradient = Vector6d::Zero();
};

// Of sum e' W e / 2 over T_target_source * Exp(x), e = target - source in the source frame: de/dx = [-I, Hat(source)].
// With the target's point in one of the two factors the information is the true second derivative of the point method,
// and surfaces that only one of the clouds has hold nothing.
enum class Curvature { kGaussNewton, kTrue };

// M Hat(v) row by row, and Hat(v) M column by column.
Eigen::Matrix3d TimesHat(const Eigen::Matrix3d& M, const Eigen::Vector3d& v) {
  Eigen::Matrix3d product;
  for (int i = 0; i < 3; ++i) product.row(i) = M.row(i).cross(v.transpose());
  return product;
}
Eigen::Matrix3d HatTimes(const Eigen::Vector3d& v, const Eigen::Matrix3d& M) {
  Eigen::Matrix3d product;
  for (int i = 0; i < 3; ++i) product.col(i) = v.cross(M.col(i));
  return product;
}

Expansion Expand(std::span<const Pair> pairs, Curvature curvature) {
  Eigen::Matrix3d W_sum = Eigen::Matrix3d::Zero(), W_hat = W_sum, hat_W_hat = W_sum, trace_squares = W_sum;
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = force, trace_source = force;
  for (const Pair& pair : pairs) {
    const Eigen::Matrix3d& W = pair.information;
    const Eigen::Vector3d& other = curvature == Curvature::kTrue ? pair.target : pair.source;
    const Eigen::Vector3d We = W * (pair.target - pair.source);
    W_sum += W;
    W_hat += TimesHat(W, 0.5 * (pair.source + other));
    hat_W_hat += HatTimes(pair.source, TimesHat(W, other));
    force += We;
    torque += pair.source.cross(We);
    trace_source += W.trace() * pair.source;
    trace_squares += W.trace() * pair.source * pair.source.transpose();
  }
  Expansion sum;
  Matrix6d& H = sum.sums.information;
  H.topLeftCorner<3, 3>() = W_sum;
  H.topRightCorner<3, 3>() = -W_hat;
  H.bottomLeftCorner<3, 3>() = -W_hat.transpose();
  H.bottomRightCorner<3, 3>() = -0.5 * (hat_W_hat + hat_W_hat.transpose());
  Matrix6d& whole = sum.sums.whole;
  whole.topLeftCorner<3, 3>() = W_sum.trace() * Eigen::Matrix3d::Identity();
  whole.topRightCorner<3, 3>() = -Hat(trace_source);
  whole.bottomLeftCorner<3, 3>() = Hat(trace_source);
  whole.bottomRightCorner<3, 3>() = trace_squares.trace() * Eigen::Matrix3d::Identity() - trace_squares;
  sum.gradient << -force, -torque;
  return sum;
}

// The step x of T_target_source * Exp(x).
Vector6d StepOf(std::span<const Pair> pairs, AlignMethod method) {
  if (method != AlignMethod::kPoint) {
    const Expansion sum = Expand(pairs, Curvature::kGaussNewton);
    return StepWhereHeld(SplitIntoShares(sum.sums), sum.gradient);
  }
  std::vector<PointPair> weighted(pairs.size());
  std::ranges::transform(pairs, weighted.begin(), [](const Pair& pair) {
    return PointPair{pair.source, pair.target, pair.information(0, 0)};
  });
  return Log(FitRigid(weighted));
}

// Covariance and undetermined motions from the last pairs, moved from the centroids to the clouds' own origins.
void Judge(const std::vector<Pair>& pairs, const Eigen::Vector3d& source_centroid, AlignResult& result) {
  Matrix6d adjoint = Matrix6d::Identity();  // Exp(adjoint * x) = Trans(centroid) Exp(x) Trans(-centroid)
  adjoint.topRightCorner<3, 3>() = Hat(source_centroid);
  const PairSums sums = Expand(pairs, Curvature::kTrue).sums;
  result.undetermined = FindUndetermined(SplitIntoShares(sums));
  result.undetermined.directions = (adjoint * result.undetermined.directions).colwise().normalized();
  if (result.undetermined.count() > 0) {
    result.end = AlignEnd::kUndetermined;
    return;
  }
  double chi2 = 0.0;
  for (const Pair& pair : pairs) chi2 += Residual(pair) * Residual(pair);
  const double freedom = std::max(1.0, static_cast<double>(pairs.size()) - 6.0);
  const Matrix6d about_centroid = sums.information.ldlt().solve(Matrix6d::Identity()) * (chi2 / freedom);
  result.covariance = adjoint * about_centroid * adjoint.transpose();
}

}  // namespace

AlignResult Align(const Cloud& source, const Cloud& target, const Pose& T_target_source_guess,
                  const AlignConfig& config) {
  AlignResult result;
  result.T_target_source = T_target_source_guess;
  result.undetermined = FindUndetermined(Shares{});  // without pairs nothing is held
  if (source.size() < kPairsMin || target.size() < kPairsMin) return result;
  const Problem problem(source, target, config);
  const bool point = problem.config.method == AlignMethod::kPoint;
  const double share = point ? kMaxDistanceSharePoint : kMaxDistanceShare;
  result.method = problem.config.method;
  result.max_distance_m = config.max_distance_m > 0.0 ? config.max_distance_m : share * Diagonal_m(target);
  const double size_m = Size_m(problem.source);
  const auto shift = [](const Eigen::Vector3d& by) { return Pose(Eigen::Translation3d(by)); };
  Pose T = shift(-problem.target_centroid) * T_target_source_guess * shift(problem.source_centroid);

  double kernel_least = result.max_distance_m / (std::sqrt(2.0) * problem.source.Sigma_m(0));
  Vector6d former = Vector6d::Zero();
  double damping = 1.0;
  bool small_step = false, narrow = true;
  std::size_t stride = point ? 1 : std::max<std::size_t>(1, source.size() / kCoarsePoints);
  TrackedNeighbours targets(problem.target_tree, problem.target.positions, source.size(), result.max_distance_m);
  std::vector<Pair> pairs;
  while (true) {
    pairs = FindPairs(problem, T, stride, targets, result);
    result.T_target_source = shift(problem.target_centroid) * T * shift(-problem.source_centroid);
    const bool few = pairs.size() < kPairsMin || result.overlap < config.overlap_min;
    if (stride > 1 &&
        (few || small_step || result.iterations >= std::min(config.iterations_max, kCoarseIterationsMax))) {
      stride = 1;  // from here on all points are used
      small_step = false;
      continue;
    }
    if (few) return result;
    if (!point) narrow = Soften(pairs, kernel_least);
    if (small_step || result.iterations == config.iterations_max) break;
    ++result.iterations;
    Vector6d step = StepOf(pairs, problem.config.method);
    if (!point && narrow && result.iterations > kDampingAfter) {
      const double turns_m2 = size_m * size_m * step.tail<3>().dot(former.tail<3>());
      const bool back = step.head<3>().dot(former.head<3>()) + turns_m2 < 0.0;
      damping = back ? std::max(0.5 * damping, kDampingMin) : std::min(2.0 * damping, 1.0);
      former = step;
      step *= damping;
    }
    T = T * Exp(step);
    const double small = std::max(config.step_converged, stride > 1 ? kCoarseStep : 0.0);
    small_step = narrow && step.head<3>().norm() + size_m * step.tail<3>().norm() <= small * size_m;
    kernel_least *= kNarrowing;
  }
  result.end = small_step ? AlignEnd::kConverged : AlignEnd::kIterations;
  if (small_step) Judge(pairs, problem.source_centroid, result);
  return result;
}

}  // namespace merlin
