#include "sim/tof/optics.h"

#include <cmath>

namespace merlin::sim {

Optics::Optics(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects)
    : width(sheet.camera.width),
      height(sheet.camera.height),
      per_pixel(effects.flying ? kSubRaysPerEdge * kSubRaysPerEdge : 1),
      tan_half_x(0.5 * width / sheet.camera.fx_px),
      tan_half_y(0.5 * height / sheet.camera.fy_px),
      lobe_exponent(effects.lamp ? -std::log(errors.lamp_at_edge) : 0.0),
      // A uniform lamp lights exactly the field of view; a lamp with a lobe also lights what lies beside it.
      lamp_reach(effects.lamp ? 1.6 : 1.0) {
  if (effects.lamp && errors.lamp_baseline_m > 0.0) {
    const float baseline = static_cast<float>(errors.lamp_baseline_m);
    boards = {{{-baseline, 0, 0}, 0.5f}, {{baseline, 0, 0}, 0.5f}};
  } else {
    boards = {Board{}};
  }
  const int edge = effects.flying ? kSubRaysPerEdge : 1;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double cosine = sheet.camera.Ray(u, v).z();
      lens.push_back(effects.lamp ? static_cast<float>(std::pow(cosine, 4)) : 1.0f);
      first_sub_ray.push_back(static_cast<std::size_t>(v * width * edge * edge + u));
    }
    for (int s = 0; s < edge * edge; ++s) {
      const double du = (s % edge + 0.5) / edge - 0.5, dv = (s / edge + 0.5) / edge - 0.5;
      for (int u = 0; u < width; ++u) {
        const Eigen::Vector3d ray = sheet.camera.Ray(u + du, v + dv);
        x.push_back(static_cast<float>(ray.x()));
        y.push_back(static_cast<float>(ray.y()));
        z.push_back(static_cast<float>(ray.z()));
        lit_and_seen.push_back(lens[static_cast<std::size_t>(v * width + u)] *
                               static_cast<float>(Lobe(ray.x() / ray.z(), ray.y() / ray.z())));
      }
    }
  }
}

double Optics::Lobe(double slope_x, double slope_y) const {
  const double rx = slope_x / tan_half_x, ry = slope_y / tan_half_y;
  return std::exp(-lobe_exponent * (rx * rx + ry * ry));
}

}  // namespace merlin::sim
