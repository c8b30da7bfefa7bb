#include "scenarios/config/hardware_file.h"

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "robot/base/yaml_visitor.h"
#include "robot/description/description.h"
#include "scenarios/config/hardware_check.h"
#include "scenarios/config/names.h"

namespace merlin {

HardwareConfig ReadHardwareFile(const std::filesystem::path& yaml) {
  const std::string file = yaml.string();
  if (!std::filesystem::is_regular_file(yaml))
    throw InputError(file, "no such file", "a YAML file that names the car's devices");
  YAML::Node root;
  try {
    root = YAML::LoadFile(file);
  } catch (const YAML::Exception& error) {
    throw InputError(file + ":" + std::to_string(error.mark.line + 1), "not YAML: " + error.msg);
  }
  HardwareConfig config;
  std::vector<std::string> faults;
  YamlReader(root, file, "", {}, faults).ReadInto(config);
  std::string all;
  for (const std::string& fault : faults) all += (all.empty() ? "" : "\n") + fault;
  if (!all.empty()) throw InputError(all);
  RequireDistinctDevices(config, yaml);
  return config;
}

std::string ToYaml(const HardwareConfig& config) {
  YAML::Emitter out;
  out.SetDoublePrecision(17);
  HardwareConfig copy = config;
  YamlWriter(out).Write(copy);
  return std::string(out.c_str()) + "\n";
}

HardwareCameras CamerasOf(const Scenario& scenario) {
  const CarDescription car = ReadCar(CarFile(scenario.car.model));
  const DepthSensor& depth = scenario.sensors.depth;
  HardwareCameras cameras{
      .depth = {ReadDepthCameraSheet(DepthCameraFile(depth.camera)), car.T_base_depth, depth.rate_hz},
      .depth_settings = SettingsOf(depth)};
  cameras.depth.sheet.latency_s = depth.latency_s.value_or(cameras.depth.sheet.latency_s);
  if (const auto& color = scenario.sensors.color; color && car.T_base_color) {
    cameras.color = {ReadColorCameraSheet(ColorCameraFile(color->camera)), *car.T_base_color, color->rate_hz};
    cameras.color->sheet.latency_s = color->latency_s.value_or(cameras.color->sheet.latency_s);
    cameras.color_settings = DefaultSettings(cameras.color->sheet);
    if (color->exposure_us) cameras.color_settings = {.exposure_s = *color->exposure_us * 1e-6, .auto_exposure = false};
  }
  return cameras;
}

DepthSettings SettingsOf(const DepthSensor& sensor) {
  return {.integration_s = sensor.integration_us * 1e-6,
          .frequency_hz = sensor.frequency_mhz * 1e6,
          .second_frequency_hz = sensor.second_frequency_mhz * 1e6,
          .post_processing = sensor.post_processing};
}

}  // namespace merlin
