#include "slam/register/normals.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace merlin {
namespace {

// Ratios of variances. The neighbours of a point on a curve spread in one direction; those in a filled volume are not
// flat.
constexpr double kLineShare = 1e-6, kWideShare = 0.15, kFlatShare = 0.2;

Eigen::Matrix3d Spread(const Cloud& cloud, const Eigen::Vector3d& at, std::span<const Neighbour> near) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Neighbour& neighbour : near) {
    const Eigen::Vector3d d = cloud.positions[neighbour.index] - at;
    sum += d;
    squares += d * d.transpose();
  }
  const double n = static_cast<double>(near.size());
  return squares / n - sum / n * (sum / n).transpose();
}

}  // namespace

Surfaces FindSurfaces(const Cloud& cloud, const Neighbours& neighbours, int count) {
  Surfaces surfaces;
  surfaces.normals.reserve(cloud.size());
  std::vector<Neighbour> found(static_cast<std::size_t>(count));
  std::size_t flat = 0;
  double reach_m = Neighbours::kAnywhere_m;
  Eigen::Vector3d former = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& position : cloud.positions) {
    // Points come in the order of a scan: the neighbours of the point before are near, and limit the search.
    if (reach_m < Neighbours::kAnywhere_m) reach_m = (reach_m + (position - former).norm()) * (1.0 + 1e-9);
    const std::size_t n = neighbours.Nearest(position, found, reach_m);
    if (n == found.size()) reach_m = std::sqrt(found.back().squared_m2);
    former = position;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(Spread(cloud, position, std::span(found).first(n)));  // closed form: takes a tenth of the time
    const Eigen::Vector3d v = solver.eigenvalues();
    const bool line = !(v(2) > 0.0 && v(1) > kLineShare * v(2));
    surfaces.normals.push_back(line ? Eigen::Vector3d(0.0, 0.0, 0.0) : Eigen::Vector3d(solver.eigenvectors().col(0)));
    if (!line && v(1) >= kWideShare * v(2) && v(0) <= kFlatShare * v(1)) ++flat;
  }
  surfaces.share = cloud.size() > 0 ? static_cast<double>(flat) / static_cast<double>(cloud.size()) : 0.0;
  return surfaces;
}

}  // namespace merlin
