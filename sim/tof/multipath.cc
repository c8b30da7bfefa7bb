#include "sim/tof/multipath.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/tof/lanes.h"
#include "sim/tof/parallel.h"
#include "sim/tof/sin_cos.h"

namespace merlin::sim {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kFaint = 2e-3f;  // share of the sum of all lights below which no shadow ray is traced for a light
constexpr float kSameNormal = 0.95f, kSamePlane_m = 0.05f;

// Surfaces lit by the lamp, as virtual lights; world frame.
struct Lights {
  std::vector<float> x, y, z, normal_x, normal_y, normal_z;
  std::vector<float> range_m;  // from the lamp
  std::vector<float> power;    // albedo / pi times its share of the lamp's light: solid angle times lobe
  std::vector<float> disc_m2;  // area of surface that it stands for, over pi
};

struct Receiver {
  Eigen::Vector3f point, normal;
  int geom = -1;
  Phasors light;
  bool Like(const RayHit& hit, const Eigen::Vector3f& at) const {
    return geom >= 0 && normal.dot(hit.normal) > kSameNormal && std::abs(normal.dot(at - point)) < kSamePlane_m;
  }
};

Lights LightsOf(const RayScene& scene, const Optics& optics, const Pose& T_world_camera, std::span<const float> albedo,
                const MultipathGrid& grid) {
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
  Lights lights;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const RayHit& hit = hits[i];
    if (hit.geom < 0) continue;
    const float toward = std::max(-hit.normal.dot(rays[i].direction), 0.05f);
    const Eigen::Vector3f point = origin + hit.range_m * rays[i].direction;
    lights.x.push_back(point.x()), lights.y.push_back(point.y()), lights.z.push_back(point.z());
    lights.normal_x.push_back(hit.normal.x()), lights.normal_y.push_back(hit.normal.y());
    lights.normal_z.push_back(hit.normal.z());
    lights.range_m.push_back(hit.range_m);
    lights.power.push_back(static_cast<float>(solid_angle[i] * lobe[i]) / kPi *
                           std::min(albedo[static_cast<std::size_t>(hit.geom)], 1.0f));
    lights.disc_m2.push_back(static_cast<float>(solid_angle[i]) * hit.range_m * hit.range_m / (toward * kPi));
  }
  return lights;
}

// Scratch buffers.
struct GatherScratch {
  std::vector<float> distance_m, electrons, phase, sine, cosine;  // [light]
  std::vector<Ray> rays;
  std::vector<std::size_t> of;  // [ray] its light
  std::vector<std::uint8_t> blocked;
};

// Sum over the lights that reach a point. Form factor of a disc: cos cos / (r^2 + A / pi) (Hanrahan's approximation).
Phasors Gather(const RayScene& scene, const Lights& lights, const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
               float wave_number, GatherScratch& scratch) {
  const std::size_t count = lights.power.size();
  auto& [distance_m, electrons, phase, sine, cosine, rays, of, blocked] = scratch;
  for (std::vector<float>* of_lights : {&distance_m, &electrons, &phase, &sine, &cosine}) of_lights->resize(count);
  {
    const float px = point.x(), py = point.y(), pz = point.z(), nx = normal.x(), ny = normal.y(), nz = normal.z();
    const float *x = lights.x.data(), *y = lights.y.data(), *z = lights.z.data();
    const float *lx = lights.normal_x.data(), *ly = lights.normal_y.data(), *lz = lights.normal_z.data();
    const float *power = lights.power.data(), *disc_m2 = lights.disc_m2.data(), *range_m = lights.range_m.data();
    float *distance = distance_m.data(), *gain = electrons.data(), *turn = phase.data();
    MERLIN_SIDE_BY_SIDE
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = x[i] - px, dy = y[i] - py, dz = z[i] - pz, squared = dx * dx + dy * dy + dz * dz;
      const float here = nx * dx + ny * dy + nz * dz,
                  there = -(lx[i] * dx + ly[i] * dy + lz[i] * dz);  // times distance
      distance[i] = std::sqrt(squared);
      const float least = 1e-4f * distance[i];
      const float form = power[i] * here * there / (squared * (squared + disc_m2[i]));
      gain[i] = ((here > least) & (there > least)) ? form : 0.0f;
      turn[i] = wave_number * 0.5f * (range_m[i] + distance[i]);
    }
  }
  SinCos(phase, sine, cosine);
  float unblocked_e = 0.0f;
  for (const float light_e : electrons) unblocked_e += light_e;
  Phasors sum;
  rays.clear();
  of.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (electrons[i] <= 0.0f) continue;
    if (electrons[i] < kFaint * unblocked_e) {
      sum.Add(electrons[i], cosine[i], sine[i]);
      continue;
    }
    const Eigen::Vector3f to_light = Eigen::Vector3f(lights.x[i], lights.y[i], lights.z[i]) - point;
    rays.push_back({.origin = point + kClear_m * normal,
                    .direction = to_light / distance_m[i],
                    .max_range_m = distance_m[i] - 5.0f * kClear_m});
    of.push_back(i);
  }
  blocked.resize(rays.size());
  scene.Occluded(rays, blocked, Panes::kLookedThrough);
  for (std::size_t r = 0; r < rays.size(); ++r)
    if (!blocked[r]) sum.Add(electrons[of[r]], cosine[of[r]], sine[of[r]]);
  return sum;
}

// Receivers: pixels on a regular grid that are computed. The first and last column and row are among them.
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

// Interpolates between the receivers around the pixel that lie on the same plane; if there are none, takes the nearest
// one that does.
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

// For pixels without a receiver on their plane: [pixel] the pixel to the left or above whose light they share, or
// themselves. Indirect light is smooth: over a few pixels of one plane it is the same.
std::vector<std::size_t> AsAnother(const Optics& optics, const MidHits& mid, std::span<const std::uint8_t> alone) {
  constexpr int kReach_px = 2;
  const auto like = [&](std::size_t a, std::size_t b) {
    const RayHit &at_a = mid.hits[optics.Middle(a)], &at_b = mid.hits[optics.Middle(b)];
    const Eigen::Vector3f apart = mid.Point(optics.Middle(a)) - mid.Point(optics.Middle(b));
    return at_a.normal.dot(at_b.normal) > kSameNormal && std::abs(at_a.normal.dot(apart)) < kSamePlane_m;
  };
  std::vector<std::size_t> as(optics.pixels());
  for (std::size_t pixel = 0; pixel < as.size(); ++pixel) as[pixel] = pixel;
  for (int v = 0; v < optics.height; ++v) {
    for (int u = 0; u < optics.width; ++u) {
      const std::size_t pixel = static_cast<std::size_t>(v * optics.width + u);
      for (int dv = 0; dv <= kReach_px && alone[pixel] && as[pixel] == pixel; ++dv) {
        for (int du = -kReach_px; du <= kReach_px; ++du) {
          if (v - dv < 0 || u + du < 0 || u + du >= optics.width || (dv == 0 && du >= 0)) continue;
          const std::size_t other = static_cast<std::size_t>((v - dv) * optics.width + u + du);
          if (!alone[other] || as[other] != other || !like(pixel, other)) continue;
          as[pixel] = other;
          break;
        }
      }
    }
  }
  return as;
}

}  // namespace

std::vector<Phasors> OneBounce(const RayScene& scene, const Optics& optics, const MidHits& mid,
                               std::span<const float> albedo, double wave_number_rad_per_m, const MultipathGrid& grid,
                               int threads) {
  const float wave_number = static_cast<float>(wave_number_rad_per_m);
  const Lights lights = LightsOf(scene, optics, mid.T_world_camera, albedo, grid);
  ReceiverGrid receivers(optics, grid);
  ParallelFor(receivers.rows, threads, [&](int j) {
    GatherScratch scratch;
    for (int i = 0; i < receivers.columns; ++i) {
      const std::size_t middle = optics.Middle(receivers.PixelOf(i, j, optics));
      if (mid.hits[middle].geom < 0) continue;
      const Eigen::Vector3f point = mid.Point(middle), normal = mid.hits[middle].normal;
      receivers.receivers[static_cast<std::size_t>(j * receivers.columns + i)] = {
          point, normal, mid.hits[middle].geom, Gather(scene, lights, point, normal, wave_number, scratch)};
    }
  });
  std::vector<Phasors> bounce(optics.pixels());
  std::vector<std::uint8_t> alone(optics.pixels(), 0);
  ParallelFor(optics.height, threads, [&](int v) {
    for (int u = 0; u < optics.width; ++u) {
      const std::size_t pixel = static_cast<std::size_t>(v * optics.width + u), middle = optics.Middle(pixel);
      const RayHit& hit = mid.hits[middle];
      if (hit.geom < 0) continue;
      const std::optional<Phasors> between = Between(receivers, u, v, hit, mid.Point(middle));
      if (between) bounce[pixel] = *between;
      alone[pixel] = !between;
    }
  });
  const std::vector<std::size_t> as = AsAnother(optics, mid, alone);
  std::vector<std::size_t> own;
  for (std::size_t pixel = 0; pixel < as.size(); ++pixel)
    if (alone[pixel] && as[pixel] == pixel) own.push_back(pixel);
  ParallelFor(static_cast<int>(own.size()), threads, [&](int k) {
    GatherScratch scratch;
    const std::size_t pixel = own[static_cast<std::size_t>(k)], middle = optics.Middle(pixel);
    bounce[pixel] = Gather(scene, lights, mid.Point(middle), mid.hits[middle].normal, wave_number, scratch);
  });
  for (std::size_t pixel = 0; pixel < as.size(); ++pixel) bounce[pixel] = bounce[as[pixel]];
  return bounce;
}

}  // namespace merlin::sim
