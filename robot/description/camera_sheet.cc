#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <set>
#include <span>
#include <string_view>

#include "robot/base/config.h"
#include "robot/base/error.h"
#include "robot/base/nearest_name.h"
#include "robot/description/description.h"

namespace merlin {
namespace {

// Takes numbers out of one file and collects every fault, so that a person mends them in one go.
class SheetReader {
 public:
  explicit SheetReader(const std::filesystem::path& file) : file_(file.string()) {
    try {
      root_ = YAML::LoadFile(file_);
    } catch (const YAML::BadFile&) {
      throw InputError(file_, "cannot be read", "a camera's data sheet");
    } catch (const YAML::Exception& error) {
      throw InputError(fmt::format("{}:{}", file_, error.mark.line + 1), "broken YAML: " + error.msg);
    }
    if (!root_.IsMap()) throw InputError(file_, "no data sheet", "a map of keys");
  }

  double Number(const char* key, Range range) {
    known_.insert(key);
    const YAML::Node node = root_[key];
    if (!node.IsDefined()) return Fault(root_, fmt::format("missing key '{}'", key));
    return Check(node, key, range);
  }
  int Whole(const char* key, Range range) {
    const double number = Number(key, range);
    if (number != std::floor(number))
      Fault(root_[key], fmt::format("'{}': expected a whole number, got {}", key, number));
    return static_cast<int>(number);
  }
  double NumberOr(const char* key, Range range, double value) {
    known_.insert(key);
    return root_[key].IsDefined() ? Number(key, range) : value;
  }
  std::vector<double> Numbers(const char* key, Range range) {
    known_.insert(key);
    const YAML::Node node = root_[key];
    std::vector<double> numbers;
    if (!node.IsDefined() || !node.IsSequence() || node.size() == 0) {
      Fault(node.IsDefined() ? node : root_, fmt::format("'{}' must be a list of numbers", key));
      return numbers;
    }
    for (const YAML::Node& item : node) numbers.push_back(Check(item, key, range));
    return numbers;
  }
  bool Flag(const char* key) {
    known_.insert(key);
    const YAML::Node node = root_[key];
    bool flag = false;
    if (!node.IsDefined())
      Fault(root_, fmt::format("missing key '{}'", key));
    else if (!node.IsScalar() || !YAML::convert<bool>::decode(node, flag))
      Fault(node, fmt::format("'{}': expected true or false, got '{}'", key,
                              node.IsScalar() ? node.Scalar() : "no single value"));
    return flag;
  }
  std::string Text(const char* key) {
    known_.insert(key);
    const YAML::Node node = root_[key];
    if (node.IsDefined() && node.IsScalar()) return node.Scalar();
    Fault(root_, fmt::format("missing key '{}'", key));
    return "";
  }

  // An optional map whose keys are a config's fields, each optional, too.
  template <class Config>
  void MapOr(const char* key, Config& config) {
    known_.insert(key);
    const YAML::Node node = root_[key];
    if (!node.IsDefined() || node.IsNull()) return;
    if (!node.IsMap()) {
      Fault(node, fmt::format("'{}' must be a map of keys", key));
      return;
    }
    SheetReader inner(file_, node);
    Visit(inner, config);
    inner.RefuseUnknown();
    Append(inner.faults_);
  }
  // The visitor of such a config's fields.
  void operator()(const char* key, double& value, Range range) { value = NumberOr(key, range, value); }

  // A rule between the values of these keys; asked only of values that are right on their own.
  void Require(bool holds, std::initializer_list<const char*> keys, const std::string& rule) {
    const bool sound =
        std::ranges::none_of(keys, [this](const char* key) { return !root_[key].IsDefined() || wrong_.contains(key); });
    if (sound && !holds) Fault(root_[*keys.begin()], rule);
  }

  // Call last. Throws for unknown keys and for all faults met before.
  void Finish() {
    RefuseUnknown();
    if (!faults_.empty()) throw InputError(faults_);
  }

 private:
  SheetReader(const std::string& file, const YAML::Node& map) : file_(file), root_(map) {}

  void RefuseUnknown() {
    for (const auto& entry : root_) {
      const std::string key = entry.first.Scalar();
      if (!known_.contains(key))
        Fault(entry.first, fmt::format("unknown key '{}'; did you mean '{}'?", key, NearestName(key, known_)));
    }
  }
  double Check(const YAML::Node& node, const char* key, Range range) {
    double number = std::nan("");
    try {
      number = node.as<double>();
    } catch (const YAML::Exception&) {
    }
    if (number >= range.min && number <= range.max && std::isfinite(number)) return number;
    wrong_.insert(key);
    return Fault(node, fmt::format("'{}': expected a number in [{:g}, {:g}], got '{}'", key, range.min, range.max,
                                   node.IsScalar() ? node.Scalar() : "no single value"));
  }
  double Fault(const YAML::Node& node, const std::string& what) {
    const YAML::Mark mark = node.Mark();
    Append((mark.is_null() ? file_ : fmt::format("{}:{}", file_, mark.line + 1)) + ": " + what);
    return 1.0;  // so that what is computed from it stays finite until Finish throws
  }
  void Append(const std::string& faults) {
    if (!faults.empty()) faults_ += (faults_.empty() ? "" : "\n") + faults;
  }

  std::string file_, faults_;
  YAML::Node root_;
  std::set<std::string> known_;
  std::set<std::string> wrong_;  // keys whose value is no number in its range
};

// What only one kind of camera has tells which it is.
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
  SheetReader in(yaml);
  DepthCameraFile file;
  DepthCameraSheet& sheet = file.sheet;
  sheet.name = in.Text("name");
  CameraModel& camera = sheet.camera;
  camera.width = in.Whole("width_px", {1, 4096});
  camera.height = in.Whole("height_px", {1, 4096});
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
  sheet.sbi = in.Flag("sbi");
  sheet.readout_s = 1e-3 * in.Number("readout_ms", {0, 1000});
  sheet.low_signal_amplitude_e = in.Number("low_signal_amplitude_e", {0, 1e9});
  sheet.integration_min_s = 1e-6 * in.Number("integration_min_us", {0.1, 1e7});
  sheet.integration_max_s = 1e-6 * in.Number("integration_max_us", {0.1, 1e7});
  for (const double mhz : in.Numbers("frequencies_mhz", {0.1, 1000})) sheet.frequencies_hz.push_back(mhz * 1e6);
  in.MapOr("errors", file.errors);

  in.Require(sheet.integration_min_s <= sheet.integration_max_s, {"integration_min_us", "integration_max_us"},
             "integration_min_us is above integration_max_us");
  const std::set<double> different(sheet.frequencies_hz.begin(), sheet.frequencies_hz.end());
  in.Require(different.size() == sheet.frequencies_hz.size(), {"frequencies_mhz"}, "'frequencies_mhz' lists one twice");
  const double shortest_s = sheet.ExposureSpan_s({.integration_s = sheet.integration_min_s});
  in.Require(
      shortest_s <= 1.0 / sheet.rate_max_hz, {"rate_max_hz", "integration_min_us", "readout_ms"},
      fmt::format("'rate_max_hz': the four sub-frames of the shortest exposure take {:g} ms, a period is {:g} ms",
                  shortest_s * 1e3, 1e3 / sheet.rate_max_hz));
  in.Require(sheet.full_well_e > sheet.read_noise_e, {"full_well_e", "read_noise_e"},
             "full_well_e is not above read_noise_e");
  in.Finish();
  return file;
}

}  // namespace

CameraKind KindOfCamera(const std::filesystem::path& yaml) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(yaml.string());
  } catch (const YAML::Exception&) {
    return CameraKind::kUnknown;
  }
  if (!root.IsMap() || root.size() == 0) return CameraKind::kUnknown;
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
  SheetReader in(yaml);
  ColorCameraSheet sheet;
  sheet.name = in.Text("name");
  CameraModel& camera = sheet.camera;
  camera.width = in.Whole("width_px", {1, 8192});
  camera.height = in.Whole("height_px", {1, 8192});
  camera.fx_px = in.Number("fx_px", {1, 1e6});
  camera.fy_px = in.Number("fy_px", {1, 1e6});
  camera.cx_px = in.Number("cx_px", {-1e5, 1e5});
  camera.cy_px = in.Number("cy_px", {-1e5, 1e5});
  camera.k1 = in.NumberOr("k1", {-10, 10}, 0.0);
  camera.k2 = in.NumberOr("k2", {-10, 10}, 0.0);
  camera.p1 = in.NumberOr("p1", {-1, 1}, 0.0);
  camera.p2 = in.NumberOr("p2", {-1, 1}, 0.0);
  sheet.rate_max_hz = in.Number("rate_max_hz", {0.1, 1000});
  sheet.latency_s = 1e-3 * in.Number("latency_ms", {0, 10000});
  sheet.full_well_e = in.Number("full_well_e", {1, 1e12});
  sheet.read_noise_e = in.Number("read_noise_e", {0, 1e6});
  sheet.falloff_power = in.Number("falloff_power", {0, 16});
  sheet.exposure_nominal_s = 1e-3 * in.Number("exposure_nominal_ms", {1e-3, 1e4});
  sheet.exposure_min_s = 1e-3 * in.Number("exposure_min_ms", {1e-3, 1e4});
  sheet.exposure_max_s = 1e-3 * in.Number("exposure_max_ms", {1e-3, 1e4});
  sheet.gain_max = in.Number("gain_max", {1, 1000});
  in.Require(sheet.exposure_min_s <= sheet.exposure_nominal_s && sheet.exposure_nominal_s <= sheet.exposure_max_s,
             {"exposure_nominal_ms", "exposure_min_ms", "exposure_max_ms"},
             "exposure_nominal_ms must lie between exposure_min_ms and exposure_max_ms");
  in.Require(sheet.exposure_max_s * sheet.rate_max_hz <= 1.0, {"exposure_max_ms", "rate_max_hz"},
             "exposure_max_ms is longer than a frame at rate_max_hz");
  in.Finish();
  if (!camera.IsInvertible())
    throw InputError(yaml.string(), "k1, k2, p1, p2 fold the picture over before its edge",
                     "a lens that puts each direction at one place of the picture");
  return sheet;
}

}  // namespace merlin
