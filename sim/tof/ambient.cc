#include "sim/tof/ambient.h"

#include <cmath>
#include <numbers>

#include "sim/parallel.h"

namespace merlin::sim {
namespace {

constexpr float kClear_m = 1e-3f;
constexpr double kSkyShare = 0.1;  // engineering guess: irradiance of a clear sky at 870 nm, relative to the sun's
constexpr float kSkyDistance_m = 100.0f;

Ray RayFrom(const LitPoint& from, const Eigen::Vector3f& direction, float max_range_m) {
  return {.origin = from.point + kClear_m * from.normal, .direction = direction, .max_range_m = max_range_m};
}

void AddSun(const RayScene& scene, const Surroundings& around, std::span<const LitPoint> points, std::span<float> lit) {
  const Eigen::Vector3f to_sun = around.sun->to_sun.cast<float>();
  std::vector<Ray> rays;
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].normal.dot(to_sun) > 0.0f)
      rays.push_back(RayFrom(points[i], to_sun, kSkyDistance_m)), of.push_back(i);
  std::vector<RayHit> first(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  scene.Cast(rays, first);
  scene.Occluded(rays, blocked, Panes::kLookedThrough);
  for (std::size_t r = 0; r < rays.size(); ++r) {
    if (blocked[r]) continue;
    double share = 1.0;
    if (first[r].geom >= 0)
      share = PaneAt(-first[r].normal.dot(to_sun),
                     around.material[static_cast<std::size_t>(first[r].geom)].glass_transmission)
                  .passed;
    lit[of[r]] += static_cast<float>(share * around.sun->irradiance_w_m2_nm * points[of[r]].normal.dot(to_sun));
  }
}

// A window as a small lamp of the sky's radiance: a disc of its area, which keeps the sum finite beside it.
void AddSky(const RayScene& scene, const Surroundings& around, const Window& window, std::span<const LitPoint> points,
            std::span<float> lit) {
  const double radiance = kSkyShare * around.sun->irradiance_w_m2_nm / std::numbers::pi;
  std::vector<Ray> rays;
  std::vector<std::size_t> of;
  std::vector<double> gain;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d way = window.middle - points[i].point.cast<double>();
    const double distance_m = way.norm();
    const Eigen::Vector3d direction = way / std::max(distance_m, 1e-6);
    const double here = points[i].normal.cast<double>().dot(direction), there = std::abs(window.normal.dot(direction));
    if (here <= 0.0) continue;
    rays.push_back(RayFrom(points[i], direction.cast<float>(), static_cast<float>(distance_m)));
    of.push_back(i);
    gain.push_back(window.area_m2 * here * there / (distance_m * distance_m + window.area_m2 / std::numbers::pi));
  }
  std::vector<std::uint8_t> blocked(rays.size());
  scene.Occluded(rays, blocked, Panes::kLookedThrough);
  for (std::size_t r = 0; r < rays.size(); ++r)
    if (!blocked[r]) lit[of[r]] += static_cast<float>(radiance * gain[r]);
}

// Of one row of pixels: a mixed one at every sub-ray, else at its middle.
template <class Take>
void ForLitSubRays(const Optics& optics, const MidHits& mid, int row, const Take& take) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel), width = static_cast<std::size_t>(optics.width);
  for (std::size_t p = static_cast<std::size_t>(row) * width; p < (static_cast<std::size_t>(row) + 1) * width; ++p) {
    for (std::size_t s = 0; s < n; ++s)
      if (mid.mixed[p] || s == n / 2) take(p, p * n + s, mid.mixed[p] ? 1.0f / static_cast<float>(n) : 1.0f);
  }
}

}  // namespace

std::vector<float> Irradiance(const RayScene& scene, const Surroundings& around, std::span<const LitPoint> points) {
  std::vector<float> lit(points.size(), static_cast<float>(around.ambient_w_m2_nm));
  if (around.sun) {
    AddSun(scene, around, points, lit);
    for (const Window& window : around.windows) AddSky(scene, around, window, points, lit);
  }
  return lit;
}

std::vector<float> AmbientOfPixels(const RayScene& scene, const Surroundings& around, const Optics& optics,
                                   const MidHits& mid, std::span<const ExtraReturn> extra, int threads) {
  const float sky = around.sun ? static_cast<float>(kSkyShare * around.sun->irradiance_w_m2_nm) : 0.0f;
  std::vector<float> ambient(optics.pixels(), 0.0f);
  ParallelFor(optics.height, threads, [&](int row) {
    std::vector<LitPoint> points;
    std::vector<std::size_t> pixel;
    std::vector<float> weight;
    ForLitSubRays(optics, mid, row, [&](std::size_t p, std::size_t i, float share) {
      const int geom = mid.hits[i].geom;
      if (geom < 0) {
        ambient[p] += share * sky;
        return;
      }
      points.push_back({mid.Point(i), mid.hits[i].normal});
      pixel.push_back(p);
      weight.push_back(share * static_cast<float>(around.material[static_cast<std::size_t>(geom)].nir_albedo));
    });
    const std::vector<float> lit = Irradiance(scene, around, points);
    for (std::size_t i = 0; i < lit.size(); ++i) ambient[pixel[i]] += weight[i] * lit[i];
  });
  std::vector<LitPoint> beyond;
  for (const ExtraReturn& one : extra) beyond.push_back({one.point, one.hit.normal});
  const std::vector<float> lit = Irradiance(scene, around, beyond);
  for (std::size_t i = 0; i < extra.size(); ++i) {
    const int geom = extra[i].hit.geom;
    const float there =
        geom < 0 ? sky : lit[i] * static_cast<float>(around.material[static_cast<std::size_t>(geom)].nir_albedo);
    ambient[extra[i].sub_ray / static_cast<std::size_t>(optics.per_pixel)] +=
        extra[i].ambient_share * there / static_cast<float>(optics.per_pixel);
  }
  return ambient;
}

std::vector<std::uint8_t> LampShadows(const RayScene& scene, const Optics& optics, const MidHits& mid, int threads) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel);
  std::vector<std::uint8_t> shadow(mid.hits.size(), 0);
  ParallelFor(optics.height, threads, [&](int row) {
    for (std::size_t b = 0; b < optics.boards.size(); ++b) {
      const Eigen::Vector3f lamp = (mid.T_world_camera * optics.boards[b].position.cast<double>()).cast<float>();
      std::vector<Ray> rays;
      std::vector<std::size_t> of;
      ForLitSubRays(optics, mid, row, [&](std::size_t, std::size_t i, float) {
        if (mid.hits[i].geom < 0) return;
        const LitPoint from{mid.Point(i), mid.hits[i].normal};
        const Eigen::Vector3f way = lamp - from.point;
        rays.push_back(RayFrom(from, way.normalized(), way.norm()));
        of.push_back(i);
      });
      std::vector<std::uint8_t> blocked(rays.size());
      scene.Occluded(rays, blocked, Panes::kLookedThrough);
      for (std::size_t r = 0; r < rays.size(); ++r) {
        if (!blocked[r]) continue;
        const std::size_t pixel = of[r] / n;
        const std::size_t begin = mid.mixed[pixel] ? of[r] : pixel * n,
                          end = mid.mixed[pixel] ? of[r] + 1 : (pixel + 1) * n;
        for (std::size_t i = begin; i < end; ++i) shadow[i] |= static_cast<std::uint8_t>(1u << b);
      }
    }
  });
  return shadow;
}

}  // namespace merlin::sim
