#include "slam/map/clear_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

constexpr float kWidest = 1.732f;      // tangent of 60 deg

// Of a bin and its neighbours to the left, below, and both: the rays on all sides of the corner between them.
float Shortest(const std::vector<float>& free_m, std::size_t width, std::size_t row, std::size_t column) {
  float shortest = 0.0f;
  for (const std::size_t bin : {row * width + column, row * width + column - 1, (row - 1) * width + column, (row - 1) * width + column - 1})
    if (free_m[bin] > 0.0f && (shortest == 0.0f || free_m[bin] < shortest)) shortest = free_m[bin];
  return shortest;
}

}  // namespace

ClearView::ClearView(std::span<const Point> points_base, std::span<const Eigen::Vector3f> free_base,
                     const Eigen::Vector3f& camera_base)
    : camera_base_(camera_base) {
  std::vector<Eigen::Vector3f> rays;
  rays.reserve(points_base.size() + free_base.size());
  for (const Point& point : points_base) rays.push_back(point.position - camera_base);
  for (const Eigen::Vector3f& end : free_base) rays.push_back(end - camera_base);
  std::erase_if(rays, [](const Eigen::Vector3f& ray) { return !(ray.allFinite() && ray.norm() > 1e-3f); });

  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& ray : rays) middle += ray.normalized();
  const Eigen::Vector3f level = Eigen::Vector3f::UnitZ().cross(middle);
  if (!(middle.norm() > 1e-3f * static_cast<float>(rays.size())) || !(level.norm() > 1e-3f * middle.norm())) return;
  R_view_base_.row(0) = middle.normalized();
  R_view_base_.row(1) = level.normalized();
  R_view_base_.row(2) = R_view_base_.row(0).cross(R_view_base_.row(1));

  for (Eigen::Vector3f& ray : rays) ray = R_view_base_ * ray;
  std::erase_if(rays, [](const Eigen::Vector3f& ray) { return !(ray.tail<2>().norm() < kWidest * ray.x()); });
  if (rays.empty()) return;
  Eigen::Array2f low(kWidest, kWidest), high(-kWidest, -kWidest);
  for (const Eigen::Vector3f& ray : rays) {
    const Eigen::Array2f tangents = ray.tail<2>().array() / ray.x();
    low = low.min(tangents), high = high.max(tangents);
    reach_m_ = std::max(reach_m_, ray.norm());
  }
  // One ray a bin, about, and an empty border.
  const float bin = std::max(1e-3f, std::sqrt((high - low).prod() / static_cast<float>(rays.size())));
  const Eigen::Array2f origin = low - bin;
  const Eigen::Array2<std::size_t> bins = ((high - low) / bin).cast<std::size_t>() + 3;
  std::vector<float> nearest_m(bins.prod(), 0.0f);
  for (const Eigen::Vector3f& ray : rays) {
    const Eigen::Array2<std::size_t> at = ((ray.tail<2>().array() / ray.x() - origin) / bin).cast<std::size_t>().min(bins - 2);
    float& nearest = nearest_m[at.y() * bins.x() + at.x()];
    nearest = nearest == 0.0f ? ray.norm() : std::min(nearest, ray.norm());
  }
  left_ = origin.x() + 0.5f * bin, low_ = origin.y() + 0.5f * bin, per_bin_ = 1.0f / bin;
  width_ = bins.x() - 1, height_ = bins.y() - 1;
  for (std::size_t row = 1; row < bins.y(); ++row)
    for (std::size_t column = 1; column < bins.x(); ++column) free_m_.push_back(Shortest(nearest_m, bins.x(), row, column));
}

}  // namespace merlin
