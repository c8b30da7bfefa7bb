#include "sim/tof/multipath.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/parallel.h"

namespace merlin::sim {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kClear_m = 1e-3f;
constexpr float kSameNormal = 0.95f, kSamePlane_m = 0.05f;

struct Light {
  Eigen::Vector3f point, normal;  // world
  float range_m = 0.0f;           // from the lamp
  float power = 0.0f;             // albedo / pi times its share of the lamp's light: solid angle times lobe
  float area_m2 = 0.0f;           // of surface it stands for
};

struct Receiver {
  Eigen::Vector3f point, normal;
  int geom = -1;
  Phasors light;
  bool Like(const RayHit& hit, const Eigen::Vector3f& at) const {
    return geom >= 0 && normal.dot(hit.normal) > kSameNormal && std::abs(normal.dot(at - point)) < kSamePlane_m;
  }
};

std::vector<Light> Lights(const RayScene& scene, const Optics& optics, const Pose& T_world_camera,
                          std::span<const float> albedo, const MultipathGrid& grid) {
  const double reach_x = optics.lamp_reach * optics.tan_half_x, reach_y = optics.lamp_reach * optics.tan_half_y;
  const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
  const Eigen::Vector3f origin = T_world_camera.translation().cast<float>();
  std::vector<Ray> rays;
  std::vector<double> solid_angle, lobe;
  for (int j = 0; j < grid.lights_y; ++j) {
    for (int i = 0; i < grid.lights_x; ++i) {
      const double x = reach_x * ((2.0 * i + 1.0) / grid.lights_x - 1.0),
                   y = reach_y * ((2.0 * j + 1.0) / grid.lights_y - 1.0);
      const Eigen::Vector3f direction = R * Eigen::Vector3d(x, y, 1.0).normalized().cast<float>();
      rays.push_back({.origin = origin, .direction = direction});
      solid_angle.push_back(4.0 * reach_x * reach_y / (grid.lights_x * grid.lights_y) *
                            std::pow(1.0 + x * x + y * y, -1.5));
      lobe.push_back(optics.Lobe(x, y));
    }
  }
  std::vector<RayHit> hits(rays.size());
  scene.Cast(rays, hits);
  std::vector<Light> lights;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].geom < 0) continue;
    const float toward = std::max(-hits[i].normal.dot(rays[i].direction), 0.05f);
    lights.push_back({.point = origin + hits[i].range_m * rays[i].direction,
                      .normal = hits[i].normal,
                      .range_m = hits[i].range_m,
                      .power = static_cast<float>(solid_angle[i] * lobe[i]) / kPi *
                               std::min(albedo[static_cast<std::size_t>(hits[i].geom)], 1.0f),
                      .area_m2 = static_cast<float>(solid_angle[i]) * hits[i].range_m * hits[i].range_m / toward});
  }
  return lights;
}

// Sum over the lights that reach a point: form factor of a disc, cos cos / (r^2 + A / pi) (Hanrahan's approximation).
Phasors Gather(const RayScene& scene, std::span<const Light> lights, const Eigen::Vector3f& point,
               const Eigen::Vector3f& normal, float wave_number) {
  std::vector<Ray> rays;
  std::vector<float> electrons, way_m;
  for (const Light& light : lights) {
    const Eigen::Vector3f way = light.point - point;
    const float squared = way.squaredNorm();
    const float here = normal.dot(way), there = -light.normal.dot(way);  // times the distance
    if (here <= 1e-4f * std::sqrt(squared) || there <= 1e-4f * std::sqrt(squared)) continue;
    const float distance = std::sqrt(squared);
    rays.push_back(
        {.origin = point + kClear_m * normal, .direction = way / distance, .max_range_m = distance - 5.0f * kClear_m});
    electrons.push_back(light.power * here * there / (squared * (squared + light.area_m2 / kPi)));
    way_m.push_back(0.5f * (light.range_m + distance));
  }
  std::vector<std::uint8_t> blocked(rays.size());
  scene.Occluded(rays, blocked, Panes::kLookedThrough);
  Phasors sum;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (blocked[i]) continue;
    const float phase = wave_number * way_m[i];
    sum.Add(electrons[i], std::cos(phase), std::sin(phase));
  }
  return sum;
}

// Pixels on an even grid that are computed; the first and last column and row are among them.
struct ReceiverGrid {
  int columns, rows;
  double step_x, step_y;
  std::vector<Receiver> receivers;

  ReceiverGrid(const Optics& optics, const MultipathGrid& grid)
      : columns(std::clamp(grid.receivers_across, 1, optics.width)),
        rows(std::clamp(grid.receivers_across * optics.height / optics.width, 1, optics.height)),
        step_x(columns > 1 ? (optics.width - 1.0) / (columns - 1) : optics.width),
        step_y(rows > 1 ? (optics.height - 1.0) / (rows - 1) : optics.height),
        receivers(static_cast<std::size_t>(columns * rows)) {}
  std::size_t PixelOf(int i, int j, const Optics& optics) const {
    return static_cast<std::size_t>(std::lround(j * step_y) * optics.width + std::lround(i * step_x));
  }
  const Receiver& At(int i, int j) const { return receivers[static_cast<std::size_t>(j * columns + i)]; }
};

void AddWeighted(Phasors& sum, const Phasors& light, float weight) {
  sum.total_e += weight * light.total_e;
  for (std::size_t h = 0; h < kHarmonics.size(); ++h) {
    sum.re[h] += weight * light.re[h];
    sum.im[h] += weight * light.im[h];
  }
}

// Between the receivers around the pixel that lie on the same plane; none of them: the nearest one that does.
std::optional<Phasors> Between(const ReceiverGrid& grid, double u, double v, const RayHit& hit,
                               const Eigen::Vector3f& at) {
  const int i = std::clamp(static_cast<int>(u / grid.step_x), 0, std::max(0, grid.columns - 2));
  const int j = std::clamp(static_cast<int>(v / grid.step_y), 0, std::max(0, grid.rows - 2));
  Phasors sum;
  float weights = 0.0f;
  for (const int reach : {0, 1}) {
    for (int b = j - reach; b <= j + 1 + reach; ++b) {
      for (int a = i - reach; a <= i + 1 + reach; ++a) {
        if (a < 0 || b < 0 || a >= grid.columns || b >= grid.rows || !grid.At(a, b).Like(hit, at)) continue;
        const double x = std::abs(u / grid.step_x - a), y = std::abs(v / grid.step_y - b);
        const float weight = static_cast<float>(std::max(1.0 + reach - x, 1e-3) * std::max(1.0 + reach - y, 1e-3));
        AddWeighted(sum, grid.At(a, b).light, weight);
        weights += weight;
      }
    }
    if (weights > 0.0f) break;
  }
  if (weights == 0.0f) return std::nullopt;
  Phasors mean;
  AddWeighted(mean, sum, 1.0f / weights);
  return mean;
}

}  // namespace

std::vector<Phasors> OneBounce(const RayScene& scene, const Optics& optics, const MidHits& mid,
                               std::span<const float> albedo, double wave_number_rad_per_m, const MultipathGrid& grid,
                               int threads) {
  const float wave_number = static_cast<float>(wave_number_rad_per_m);
  const std::vector<Light> lights = Lights(scene, optics, mid.T_world_camera, albedo, grid);
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel);
  ReceiverGrid receivers(optics, grid);
  ParallelFor(receivers.rows, threads, [&](int j) {
    for (int i = 0; i < receivers.columns; ++i) {
      const std::size_t middle = receivers.PixelOf(i, j, optics) * n + n / 2;
      if (mid.hits[middle].geom < 0) continue;
      const Eigen::Vector3f point = mid.Point(middle), normal = mid.hits[middle].normal;
      receivers.receivers[static_cast<std::size_t>(j * receivers.columns + i)] = {
          point, normal, mid.hits[middle].geom, Gather(scene, lights, point, normal, wave_number)};
    }
  });
  std::vector<Phasors> bounce(optics.pixels());
  ParallelFor(optics.height, threads, [&](int v) {
    for (int u = 0; u < optics.width; ++u) {
      const std::size_t pixel = static_cast<std::size_t>(v * optics.width + u), middle = pixel * n + n / 2;
      const RayHit& hit = mid.hits[middle];
      if (hit.geom < 0) continue;
      const Eigen::Vector3f point = mid.Point(middle);
      const std::optional<Phasors> between = Between(receivers, u, v, hit, point);
      bounce[pixel] = between ? *between : Gather(scene, lights, point, hit.normal, wave_number);
    }
  });
  return bounce;
}

}  // namespace merlin::sim
