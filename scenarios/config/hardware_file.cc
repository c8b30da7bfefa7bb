#include "scenarios/config/hardware_file.h"

#include "robot/base/yaml_reader.h"
#include "robot/base/yaml_writer.h"
#include "robot/description/description.h"
#include "scenarios/config/hardware_check.h"
#include "scenarios/config/names.h"

namespace merlin {

HardwareConfig ReadHardwareFile(const std::filesystem::path& yaml) {
  YamlFile file(yaml, "a YAML file that names the car's devices");
  HardwareConfig config;
  file.ReadInto(config);
  file.ThrowFaults();
  RequireDistinctDevices(config, yaml);
  return config;
}

std::string ToYaml(const HardwareConfig& config) { return ToYamlText(config, 17); }

HardwareCameras CamerasOf(const Scenario& scenario) {
  const CarDescription car = ReadCar(CarFile(scenario.car.model));
  const DepthSensor& depth = scenario.sensors.depth;
  HardwareCameras cameras{
      .depth = {ReadDepthCameraSheet(DepthCameraFile(depth.camera)), car.T_base_depth, depth.rate_hz},
      .depth_settings = {}};
  cameras.depth_settings = SettingsOf(depth, cameras.depth.sheet);
  cameras.depth.sheet.latency_s = depth.latency_s.value_or(cameras.depth.sheet.latency_s);
  if (const auto& color = scenario.sensors.color; color && car.T_base_color) {
    cameras.color = {ReadColorCameraSheet(ColorCameraFile(color->camera)), *car.T_base_color, color->rate_hz};
    cameras.color->sheet.latency_s = color->latency_s.value_or(cameras.color->sheet.latency_s);
    cameras.color_settings = DefaultSettings(cameras.color->sheet);
    if (color->exposure_us) cameras.color_settings = {.exposure_s = *color->exposure_us * 1e-6, .auto_exposure = false};
  }
  return cameras;
}

DepthSettings SettingsOf(const DepthSensor& sensor, const DepthCameraSheet& sheet) {
  DepthSettings settings{.frequency_hz = sensor.frequency_mhz * 1e6,
                         .second_frequency_hz = sensor.second_frequency_mhz * 1e6,
                         .post_processing = sensor.post_processing};
  const std::optional<double> fixed_us = sensor.integration_us.us;
  settings.integration_s = fixed_us ? *fixed_us * 1e-6 : StartIntegration_s(sheet, settings, sensor.rate_hz);
  return settings;
}

}  // namespace merlin
