// A few boxes in front of a camera at the origin that looks along x, with z up.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "sim/tof/tof_camera.h"

namespace merlin::sim {

constexpr double kPi = std::numbers::pi;

// A 64x48 PMD camera with a field of view of 40x30 degrees and no noise; a test adds what it needs.
inline DepthCameraSheet Sheet3kS() {
  DepthCameraSheet sheet;
  sheet.name = "stage";
  sheet.camera = {.width = 64, .height = 48};
  sheet.camera.fx_px = 32.0 / std::tan(20.0 * kPi / 180.0);
  sheet.camera.fy_px = 24.0 / std::tan(15.0 * kPi / 180.0);
  sheet.camera.cx_px = 31.5;
  sheet.camera.cy_px = 23.5;
  sheet.signal_e_m2_per_us = 2000.0;
  sheet.contrast_at_20mhz = 0.45;
  sheet.contrast_corner_hz = 30e6;
  sheet.read_noise_e = 200.0;
  sheet.full_well_e = 1.5e6;
  sheet.low_signal_amplitude_e = 600.0;
  sheet.readout_s = 1e-3;
  sheet.sbi = true;
  sheet.integration_min_s = 1e-4;
  sheet.integration_max_s = 5e-3;
  sheet.frequencies_hz = {20e6, 30e6};
  return sheet;
}

// A box that a test puts into the world: full dimensions size_m, turned about the vertical, with a material of its own.
struct StageBox {
  Eigen::Vector3d middle_m, size_m;
  Material material{.nir_albedo = 0.5};
  double yaw_deg = 0.0;
};

class Stage {
 public:
  explicit Stage(const std::vector<StageBox>& boxes) {
    std::string xml = "<mujoco><compiler angle='degree'/><worldbody>";
    for (const StageBox& box : boxes) {
      xml += fmt::format("<geom type='box' pos='{} {} {}' size='{} {} {}' euler='0 0 {}'/>", box.middle_m.x(),
                         box.middle_m.y(), box.middle_m.z(), box.size_m.x() / 2, box.size_m.y() / 2, box.size_m.z() / 2,
                         box.yaw_deg);
      around.material.push_back(box.material);
      around.material_id.push_back(-1);
    }
    char error[1000] = "";
    mjSpec* spec = mj_parseXMLString((xml + "</worldbody></mujoco>").c_str(), nullptr, error, sizeof error);
    EXPECT_NE(spec, nullptr) << error;
    mjModel* model = mj_compile(spec, nullptr);
    mj_deleteSpec(spec);
    bodies = AtRest(model);
    scene = std::make_unique<RayScene>(model, std::vector<bool>(1, false), PanesOf(around));
    mj_deleteModel(model);
    camera.T_world_body.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  }
  TofView view() const { return {*scene, around, bodies, camera}; }
  DepthFrame Expose(const std::string& effects, const DepthSettings& settings = {},
                    const DepthCameraErrors& errors = {}, const DepthCameraSheet& sheet = Sheet3kS()) const {
    return TofCamera(sheet, errors, ParseTofEffects(effects), 1).Expose(view(), settings, Time{0}, 0);
  }

  Surroundings around;
  BodyMotions bodies;
  std::unique_ptr<RayScene> scene;
  BodyMotion camera;
};

// A facing wall with its near face at x_m.
inline StageBox Wall(double x_m, double albedo = 0.5, double size_m = 60.0) {
  return {{x_m + 0.5, 0, 0}, {1, size_m, size_m}, {.nir_albedo = albedo}};
}

inline double WaveNumber(double frequency_hz) { return 4.0 * kPi * frequency_hz / 299792458.0; }

// Range of the phasor sum of these electrons and ranges, in the period nearest to about_m. Computed independently.
struct Way {
  double electrons, range_m;
};
inline double RangeOfWays(const std::vector<Way>& ways, double about_m, double frequency_hz = 20e6) {
  double re = 0.0, im = 0.0;
  for (const Way& way : ways) {
    re += way.electrons * std::cos(WaveNumber(frequency_hz) * way.range_m);
    im += way.electrons * std::sin(WaveNumber(frequency_hz) * way.range_m);
  }
  const double range_m = std::atan2(im, re) / WaveNumber(frequency_hz);
  const double wrap_m = 299792458.0 / (2.0 * frequency_hz);
  return about_m + std::remainder(range_m - about_m, wrap_m);
}

inline std::size_t Pixel(int u, int v, int width = 64) { return static_cast<std::size_t>(v * width + u); }

}  // namespace merlin::sim
