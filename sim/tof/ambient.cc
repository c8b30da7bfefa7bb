#include "sim/tof/ambient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/tof/parallel.h"

namespace merlin::sim {
namespace {

constexpr double kSkyShare = 0.1;  // guess: irradiance of a clear sky at 870 nm over that of the sun
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

// A window as a small lamp with the radiance of the sky: a disc of the same area, which keeps the sum finite close to
// it.
void AddSky(const RayScene& scene, const Surroundings& around, const Window& window, std::span<const LitPoint> points,
            std::span<float> lit) {
  const double radiance = kSkyShare * around.sun->irradiance_w_m2_nm / std::numbers::pi;
  std::vector<Ray> rays;
  std::vector<std::size_t> of;
  std::vector<double> gain;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d to_window = window.middle - points[i].point.cast<double>();
    const double distance_m = to_window.norm();
    const Eigen::Vector3d direction = to_window / std::max(distance_m, 1e-6);
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

// Sub-rays of one row of pixels at which light is computed: all of a mixed pixel, else the middle one.
template <class Take>
void ForLitSubRays(const Optics& optics, const MidHits& mid, int row, const Take& take) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel), width = static_cast<std::size_t>(optics.width);
  for (std::size_t p = static_cast<std::size_t>(row) * width; p < (static_cast<std::size_t>(row) + 1) * width; ++p) {
    for (std::size_t s = 0; s < n; ++s)
      if (mid.mixed[p] || s == n / 2) take(p, optics.SubRay(p, s), mid.mixed[p] ? 1.0f / static_cast<float>(n) : 1.0f);
  }
}

// Adds one sub-ray of each face that a pixel sees, the nearest to its middle.
void AddOneOfEachFace(const Optics& optics, const MidHits& mid, std::size_t pixel, std::vector<std::size_t>& sub_rays) {
  constexpr std::array<std::size_t, 9> kFromTheMiddle{4, 1, 3, 5, 7, 0, 2, 6, 8};
  const std::size_t first_of_pixel = sub_rays.size();
  for (std::size_t k = 0; k < static_cast<std::size_t>(optics.per_pixel); ++k) {
    const std::size_t i = optics.SubRay(pixel, optics.per_pixel == 1 ? 0 : kFromTheMiddle[k]);
    const auto same = [&](std::size_t other) { return mid.hits[other].face == mid.hits[i].face; };
    if (mid.hits[i].geom >= 0 &&
        std::none_of(sub_rays.begin() + static_cast<std::ptrdiff_t>(first_of_pixel), sub_rays.end(), same))
      sub_rays.push_back(i);
  }
}

// For each of these sub-rays: bit b is set if something is between it and board b.
std::vector<std::uint8_t> BoardsBlocked(const RayScene& scene, const Optics& optics, const MidHits& mid,
                                        std::span<const std::size_t> sub_rays) {
  std::vector<std::uint8_t> bits(sub_rays.size(), 0), blocked(sub_rays.size());
  for (std::size_t b = 0; b < optics.boards.size(); ++b) {
    const Eigen::Vector3f lamp = (mid.T_world_camera * optics.boards[b].position.cast<double>()).cast<float>();
    std::vector<Ray> rays;
    for (const std::size_t i : sub_rays) {
      const LitPoint from{mid.Point(i), mid.hits[i].normal};
      const Eigen::Vector3f to_lamp = lamp - from.point;
      rays.push_back(RayFrom(from, to_lamp.normalized(), to_lamp.norm()));
    }
    scene.Occluded(rays, blocked, Panes::kLookedThrough);
    for (std::size_t r = 0; r < bits.size(); ++r) bits[r] |= static_cast<std::uint8_t>(blocked[r] << b);
  }
  return bits;
}

// False if the neighbours see other faces, or do not agree.
bool ShadeAsNeighbours(const Optics& optics, const MidHits& mid, int u, int v, std::span<std::uint8_t> shadow) {
  const auto middle = [&](int x, int y) { return optics.Middle(static_cast<std::size_t>(y * optics.width + x)); };
  const std::size_t pixel = static_cast<std::size_t>(v * optics.width + u), mine = optics.Middle(pixel);
  std::optional<std::uint8_t> bits;
  const auto agrees = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= optics.width || y >= optics.height) return true;
    const std::size_t other = middle(x, y);
    if (mid.hits[other].face != mid.hits[mine].face || shadow[other] != bits.value_or(shadow[other])) return false;
    bits = shadow[other];
    return true;
  };
  if (!agrees(u - 1, v) || !agrees(u + 1, v) || !agrees(u, v - 1) || !agrees(u, v + 1) || !bits) return false;
  for (std::size_t s = 0; s < static_cast<std::size_t>(optics.per_pixel); ++s) shadow[optics.SubRay(pixel, s)] = *bits;
  return true;
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
    ambient[optics.PixelOf(extra[i].sub_ray)] += extra[i].ambient_share * there / static_cast<float>(optics.per_pixel);
  }
  return ambient;
}

std::vector<std::uint8_t> LampShadows(const RayScene& scene, const Optics& optics, const MidHits& mid, int threads) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel);
  std::vector<std::uint8_t> shadow(mid.hits.size(), 0);
  // First every second pixel and all that see an edge; then the pixels in between for which the neighbours do not
  // decide.
  for (const bool between : {false, true}) {
    ParallelFor(optics.height, threads, [&](int v) {
      std::vector<std::size_t> sub_rays;
      for (int u = 0; u < optics.width; ++u) {
        const std::size_t pixel = static_cast<std::size_t>(v * optics.width + u);
        if (((u + v) % 2 != 0 && !mid.mixed[pixel]) != between) continue;
        if (!between || !ShadeAsNeighbours(optics, mid, u, v, shadow)) AddOneOfEachFace(optics, mid, pixel, sub_rays);
      }
      const std::vector<std::uint8_t> bits = BoardsBlocked(scene, optics, mid, sub_rays);
      const std::size_t width = static_cast<std::size_t>(optics.width), first = static_cast<std::size_t>(v) * width * n;
      for (std::size_t r = 0; r < sub_rays.size(); ++r)
        for (std::size_t i = first + (sub_rays[r] - first) % width; i < first + n * width; i += width)
          if (mid.hits[i].face == mid.hits[sub_rays[r]].face) shadow[i] = bits[r];
    });
  }
  return shadow;
}

}  // namespace merlin::sim
