#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "robot/base/config.h"
#include "robot/base/error.h"
#include "robot/base/yaml_reader.h"
#include "robot/description/description.h"

namespace merlin {
namespace {

// Keys that only one kind of camera has. They show which kind a sheet describes.
constexpr std::string_view kDepthKeys[] = {"fov_horizontal_deg", "fov_vertical_deg",    "signal_e_m2_per_us",
                                           "contrast_at_20mhz",  "contrast_corner_mhz", "low_signal_amplitude_e",
                                           "integration_min_us", "integration_max_us",  "frequencies_mhz"};
constexpr std::string_view kColorKeys[] = {"fx_px",           "fy_px",           "cx_px",
                                           "cy_px",           "falloff_power",   "exposure_nominal_ms",
                                           "exposure_min_ms", "exposure_max_ms", "gain_max"};
constexpr std::string_view kSharedKeys[] = {"width_px",   "height_px",   "rate_max_hz",
                                            "latency_ms", "full_well_e", "read_noise_e"};

double TanHalf(double angle_deg) { return std::tan(0.5 * angle_deg * std::numbers::pi / 180.0); }

struct DepthCameraFile {
  DepthCameraSheet sheet;
  DepthCameraErrors errors;
};

DepthCameraFile ReadDepthCamera(const std::filesystem::path& yaml) {
  YamlFile text(yaml, "a camera's data sheet");
  YamlReader in(text, text.root(), "");
  DepthCameraFile file;
  DepthCameraSheet& sheet = file.sheet;
  in.Need("name", sheet.name);
  CameraModel& camera = sheet.camera;
  in.Need("width_px", camera.width, {1, 4096});
  in.Need("height_px", camera.height, {1, 4096});
  camera.fx_px = 0.5 * camera.width / TanHalf(in.Number("fov_horizontal_deg", {0.1, 170}));
  camera.fy_px = 0.5 * camera.height / TanHalf(in.Number("fov_vertical_deg", {0.1, 170}));
  camera.cx_px = 0.5 * (camera.width - 1);
  camera.cy_px = 0.5 * (camera.height - 1);
  sheet.rate_max_hz = in.Number("rate_max_hz", {0.1, 1000});
  sheet.latency_s = 1e-3 * in.Number("latency_ms", {0, 10000});
  sheet.signal_e_m2_per_us = in.Number("signal_e_m2_per_us", {1e-3, 1e9});
  sheet.contrast_at_20mhz = in.Number("contrast_at_20mhz", {1e-3, 1});
  sheet.contrast_corner_hz = 1e6 * in.Number("contrast_corner_mhz", {0.1, 1e5});
  sheet.read_noise_e = in.Number("read_noise_e", {0, 1e6});
  sheet.full_well_e = in.Number("full_well_e", {1, 1e12});
  in.Need("sbi", sheet.sbi);
  sheet.readout_s = 1e-3 * in.Number("readout_ms", {0, 1000});
  sheet.low_signal_amplitude_e = in.Number("low_signal_amplitude_e", {0, 1e9});
  sheet.integration_min_s = 1e-6 * in.Number("integration_min_us", {0.1, 1e7});
  sheet.integration_max_s = 1e-6 * in.Number("integration_max_us", {0.1, 1e7});
  std::vector<double> frequencies_mhz;
  in.Need("frequencies_mhz", frequencies_mhz, {0.1, 1000});
  for (const double mhz : frequencies_mhz) sheet.frequencies_hz.push_back(mhz * 1e6);
  in("errors", file.errors);

  in.Rule(sheet.integration_min_s <= sheet.integration_max_s, {"integration_min_us", "integration_max_us"},
          "is above integration_max_us");
  const std::set<double> different(sheet.frequencies_hz.begin(), sheet.frequencies_hz.end());
  in.Rule(different.size() == sheet.frequencies_hz.size(), {"frequencies_mhz"}, "lists one twice");
  in.Rule(!frequencies_mhz.empty(), {"frequencies_mhz"}, "expected one frequency at least");
  const double shortest_s = sheet.ExposureSpan_s({.integration_s = sheet.integration_min_s});
  in.Rule(shortest_s <= 1.0 / sheet.rate_max_hz, {"rate_max_hz", "integration_min_us", "readout_ms"},
          fmt::format("the four sub-frames of the shortest exposure take {:g} ms, a period is {:g} ms",
                      shortest_s * 1e3, 1e3 / sheet.rate_max_hz));
  in.Rule(sheet.full_well_e > sheet.read_noise_e, {"full_well_e", "read_noise_e"}, "is not above read_noise_e");
  in.RefuseUnknown();
  text.ThrowFaults();
  return file;
}

}  // namespace

CameraKind KindOfCamera(const std::filesystem::path& yaml) {
  std::optional<YamlFile> file;
  try {
    file.emplace(yaml, "a camera's data sheet");
  } catch (const InputError&) {
    return CameraKind::kUnknown;
  }
  const YAML::Node& root = file->root();
  if (root.size() == 0) return CameraKind::kUnknown;
  const auto count = [&root](std::span<const std::string_view> keys) {
    return std::ranges::count_if(keys, [&](std::string_view key) { return root[std::string(key)].IsDefined(); });
  };
  const std::ptrdiff_t depth = count(kDepthKeys), color = count(kColorKeys);
  if (depth != color) return depth > color ? CameraKind::kDepth : CameraKind::kColor;
  return depth + count(kSharedKeys) > 0 ? CameraKind::kUnknown : CameraKind::kNone;
}

DepthCameraSheet ReadDepthCameraSheet(const std::filesystem::path& yaml) { return ReadDepthCamera(yaml).sheet; }

DepthCameraErrors ReadDepthCameraErrors(const std::filesystem::path& yaml) { return ReadDepthCamera(yaml).errors; }

ColorCameraSheet ReadColorCameraSheet(const std::filesystem::path& yaml) {
  YamlFile text(yaml, "a camera's data sheet");
  YamlReader in(text, text.root(), "");
  ColorCameraSheet sheet;
  in.Need("name", sheet.name);
  CameraModel& camera = sheet.camera;
  in.Need("width_px", camera.width, {1, 8192});
  in.Need("height_px", camera.height, {1, 8192});
  camera.fx_px = in.Number("fx_px", {1, 1e6});
  camera.fy_px = in.Number("fy_px", {1, 1e6});
  camera.cx_px = in.Number("cx_px", {-1e5, 1e5});
  camera.cy_px = in.Number("cy_px", {-1e5, 1e5});
  in("k1", camera.k1, {-10, 10});
  in("k2", camera.k2, {-10, 10});
  in("p1", camera.p1, {-1, 1});
  in("p2", camera.p2, {-1, 1});
  sheet.rate_max_hz = in.Number("rate_max_hz", {0.1, 1000});
  sheet.latency_s = 1e-3 * in.Number("latency_ms", {0, 10000});
  sheet.full_well_e = in.Number("full_well_e", {1, 1e12});
  sheet.read_noise_e = in.Number("read_noise_e", {0, 1e6});
  sheet.falloff_power = in.Number("falloff_power", {0, 16});
  sheet.exposure_nominal_s = 1e-3 * in.Number("exposure_nominal_ms", {1e-3, 1e4});
  sheet.exposure_min_s = 1e-3 * in.Number("exposure_min_ms", {1e-3, 1e4});
  sheet.exposure_max_s = 1e-3 * in.Number("exposure_max_ms", {1e-3, 1e4});
  sheet.gain_max = in.Number("gain_max", {1, 1000});
  in.Rule(sheet.exposure_min_s <= sheet.exposure_nominal_s && sheet.exposure_nominal_s <= sheet.exposure_max_s,
          {"exposure_nominal_ms", "exposure_min_ms", "exposure_max_ms"},
          "must lie between exposure_min_ms and exposure_max_ms");
  in.Rule(sheet.exposure_max_s * sheet.rate_max_hz <= 1.0, {"exposure_max_ms", "rate_max_hz"},
          "is longer than a frame at rate_max_hz");
  in.RefuseUnknown();
  text.ThrowFaults();
  if (!camera.IsInvertible())
    throw InputError(yaml.string(), "k1, k2, p1, p2 fold the picture over before its edge",
                     "a lens that puts each direction at one place of the picture");
  return sheet;
}

}  // namespace merlin
