#include "slam/map/clear_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace merlin {
namespace {

constexpr float kWidest = 1.732f;  // tangent of 60 deg
constexpr float kLongest_m = 100.0f;

struct Ray {
  Eigen::Vector3f end{0, 0, 0};  // from the camera
  enum class Kind { kPoint, kDark, kUnknown } kind;
};

std::vector<Ray> RaysOf(const Observation& observation) {
  std::vector<Ray> rays;
  rays.reserve(observation.points_base.size() + observation.free_base.size() + observation.saturated_base.size() +
               observation.unknown_base.size());
  for (const Point& point : observation.points_base)
    rays.push_back({point.position - observation.camera_base, Ray::Kind::kPoint});
  for (const Eigen::Vector3f& end : observation.free_base)
    rays.push_back({end - observation.camera_base, Ray::Kind::kDark});
  for (const auto& directions : {std::cref(observation.saturated_base), std::cref(observation.unknown_base)})
    for (const Eigen::Vector3f& direction : directions.get()) rays.push_back({direction, Ray::Kind::kUnknown});
  std::erase_if(rays, [](const Ray& ray) { return !(ray.end.norm() > 1e-3f && ray.end.norm() < kLongest_m); });
  return rays;
}

// x level along the middle of the rays, z up. Nothing where they point to all sides.
std::optional<Eigen::Matrix3f> LevelView(const std::vector<Ray>& rays) {
  Eigen::Vector2f middle = Eigen::Vector2f::Zero();
  for (const Ray& ray : rays) middle += ray.end.head<2>() / ray.end.norm();
  if (!(middle.norm() > 1e-3f * static_cast<float>(rays.size()))) return std::nullopt;
  middle.normalize();
  Eigen::Matrix3f R_view_base;
  R_view_base << middle.x(), middle.y(), 0.0f, -middle.y(), middle.x(), 0.0f, 0.0f, 0.0f, 1.0f;
  return R_view_base;
}

// The rays of one bin.
struct Bin {
  float shortest_m = HUGE_VALF;
  bool dark = false, unknown = false;

  void Add(const Ray& ray) {
    if (ray.kind == Ray::Kind::kUnknown)
      unknown = true;
    else
      shortest_m = std::min(shortest_m, ray.end.norm());
    dark |= ray.kind == Ray::Kind::kDark;
  }
  void Add(const Bin& other) {
    shortest_m = std::min(shortest_m, other.shortest_m);
    dark |= other.dark, unknown |= other.unknown;
  }
};

}  // namespace

ClearView::ClearView(const Observation& observation) : camera_base_(observation.camera_base) {
  std::vector<Ray> rays = RaysOf(observation);
  const auto R_view_base = LevelView(rays);
  if (!R_view_base) return;
  R_view_base_ = *R_view_base;
  for (Ray& ray : rays) ray.end = R_view_base_ * ray.end;
  std::erase_if(rays, [](const Ray& ray) { return !(ray.end.tail<2>().norm() < kWidest * ray.end.x()); });
  if (rays.empty()) return;

  Eigen::Array2f low(kWidest, kWidest), high(-kWidest, -kWidest);
  for (const Ray& ray : rays) {
    const Eigen::Array2f tangents = ray.end.tail<2>().array() / ray.end.x();
    low = low.min(tangents), high = high.max(tangents);
    if (ray.kind != Ray::Kind::kUnknown) reach_m_ = std::max(reach_m_, ray.end.norm());
  }
  // Bins with about one pixel each, and an empty border. What is kept is the minimum of the four bins around each
  // corner.
  const float pitch = std::max(1e-3f, std::sqrt((high - low).prod() / static_cast<float>(rays.size())));
  const Eigen::Array2f origin = low - pitch;
  const Eigen::Array2<std::size_t> size = ((high - low) / pitch).cast<std::size_t>() + 3;
  std::vector<Bin> bins(size.prod());
  for (const Ray& ray : rays) {
    const Eigen::Array2f place = (ray.end.tail<2>().array() / ray.end.x() - origin) / pitch;
    const Eigen::Array2<std::size_t> at = place.cast<std::size_t>().min(size - 2);
    bins[at.y() * size.x() + at.x()].Add(ray);
  }
  left_ = origin.x() + 0.5f * pitch, low_ = origin.y() + 0.5f * pitch, per_bin_ = 1.0f / pitch;
  width_ = size.x() - 1, height_ = size.y() - 1;
  lengths_.reserve(width_ * height_);
  for (std::size_t corner = 0; corner + size.x() < bins.size(); ++corner) {
    if (corner % size.x() == width_) continue;
    Bin around = bins[corner];
    for (const std::size_t beside : {corner + 1, corner + size.x(), corner + size.x() + 1}) around.Add(bins[beside]);
    const float length_m = around.unknown || around.shortest_m == HUGE_VALF ? 0.0f : around.shortest_m;
    lengths_.push_back(static_cast<std::int16_t>((around.dark ? -length_m : length_m) / kUnit_m));
  }
}

}  // namespace merlin
