#include "sim/tof/returns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin::sim {
namespace {

constexpr double kGlassIndex = 1.52;  // soda-lime float glass

struct Leg {
  ExtraReturn extra;
  Ray ray;
  Panes panes;
  float share;  // there and back
};

Eigen::Vector3f Mirrored(const Eigen::Vector3f& direction, const Eigen::Vector3f& normal) {
  return (direction - 2.0f * direction.dot(normal) * normal).normalized();
}

// The lamp's mirror image: the mirrored ray ends on a board. It looks like a board of radiance I / A.
float GlareStrength(const Eigen::Vector3f& point_camera, const Eigen::Vector3f& mirrored_camera, const Optics& optics,
                    double lamp_width_m, double reflected) {
  if (mirrored_camera.z() >= 0.0f) return 0.0f;
  const Eigen::Vector3f at_lens = point_camera - point_camera.z() / mirrored_camera.z() * mirrored_camera;
  double strength = 0.0;
  for (const Board& board : optics.boards) {
    const Eigen::Vector3f off = (at_lens - board.position).cwiseAbs();
    if (std::max(off.x(), off.y()) <= 0.5 * lamp_width_m)
      strength += board.share * std::numbers::pi * reflected / (lamp_width_m * lamp_width_m);
  }
  return static_cast<float>(strength * point_camera.squaredNorm());
}

void AddLegs(std::size_t i, const Material& material, const Optics& optics, const MidHits& mid,
             const DepthCameraErrors& errors, const TofEffects& effects, std::vector<Leg>& legs) {
  const RayHit& hit = mid.hits[i];
  const Eigen::Vector3f point = mid.Point(i), direction = mid.rays[i].direction;
  const double cosine = std::clamp(static_cast<double>(-hit.normal.dot(direction)), 0.0, 1.0);
  const bool pane = effects.glass && material.glass_transmission > 0.0;
  const PaneOptics through = pane ? PaneAt(cosine, material.glass_transmission) : PaneOptics{};
  const double reflected = pane ? through.reflected : effects.specular ? material.mirror : 0.0;
  const auto add = [&](const Eigen::Vector3f& onward, const Eigen::Vector3f& side, Panes panes, double share) {
    Leg leg{.extra = {.sub_ray = i, .geom = hit.geom},
            .ray = {.origin = point + kClear_m * side, .direction = onward},
            .panes = panes,
            .share = static_cast<float>(share * share)};
    leg.extra.ambient_share = static_cast<float>(share);
    legs.push_back(leg);
  };
  if (pane) add(direction, -hit.normal, Panes::kLookedThrough, through.passed);
  if (reflected <= 0.0) return;
  const Eigen::Vector3f mirrored = Mirrored(direction, hit.normal);
  add(mirrored, hit.normal, Panes::kSeen, reflected);
  const Eigen::Matrix3f R_camera_world = mid.T_world_camera.linear().transpose().cast<float>();
  const float glare = GlareStrength(hit.range_m * optics.Direction(i), R_camera_world * mirrored, optics,
                                    errors.lamp_width_m, reflected);
  if (glare > 0.0f) {
    Leg leg{
        .extra = {.sub_ray = i, .geom = hit.geom, .strength = glare}, .ray = {}, .panes = Panes::kSeen, .share = 0.0f};
    legs.push_back(leg);
  }
}

}  // namespace

PaneOptics PaneAt(double cosine, double glass_transmission) {
  const double sine_inside = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) / kGlassIndex;
  const double cosine_inside = std::sqrt(1.0 - sine_inside * sine_inside);
  const double s = (cosine - kGlassIndex * cosine_inside) / (cosine + kGlassIndex * cosine_inside);
  const double p = (kGlassIndex * cosine - cosine_inside) / (kGlassIndex * cosine + cosine_inside);
  const double reflected = s * s / (1.0 + s * s) + p * p / (1.0 + p * p);  // mean of both polarisations' 2 R / (1 + R)
  return {.reflected = reflected, .passed = (1.0 - reflected) * std::pow(glass_transmission, 1.0 / cosine_inside)};
}

std::vector<float> LampAlbedos(const Surroundings& around, const TofEffects& effects) {
  std::vector<float> albedo;
  for (const Material& material : around.material)
    albedo.push_back(static_cast<float>(material.nir_albedo * (effects.specular ? material.retro_gain : 1.0)));
  return albedo;
}

std::vector<ExtraReturn> TraceReturns(const RayScene& scene, const Surroundings& around, const Optics& optics,
                                      const MidHits& mid, const DepthCameraErrors& errors, const TofEffects& effects) {
  std::vector<Leg> legs;
  for (std::size_t i = 0; i < mid.hits.size(); ++i) {
    if (mid.hits[i].geom < 0) continue;
    const Material& material = around.material[static_cast<std::size_t>(mid.hits[i].geom)];
    if (material.glass_transmission > 0.0 || material.mirror > 0.0)
      AddLegs(i, material, optics, mid, errors, effects, legs);
  }
  const std::vector<float> albedo = LampAlbedos(around, effects);
  for (const Panes panes : {Panes::kSeen, Panes::kLookedThrough}) {
    std::vector<Leg*> some;
    std::vector<Ray> rays;
    for (Leg& leg : legs)
      if (leg.share > 0.0f && leg.panes == panes) some.push_back(&leg), rays.push_back(leg.ray);
    std::vector<RayHit> hits(rays.size());
    scene.Cast(rays, hits, panes);
    for (std::size_t r = 0; r < some.size(); ++r) {
      ExtraReturn& extra = some[r]->extra;
      extra.hit = hits[r];
      if (hits[r].geom < 0) continue;
      extra.beyond_m = hits[r].range_m;
      extra.point = rays[r].origin + hits[r].range_m * rays[r].direction;
      extra.strength = some[r]->share * albedo[static_cast<std::size_t>(hits[r].geom)] *
                       std::max(-hits[r].normal.dot(rays[r].direction), 0.0f);
    }
  }
  std::vector<ExtraReturn> extra;
  for (const Leg& leg : legs) extra.push_back(leg.extra);
  return extra;
}

}  // namespace merlin::sim
