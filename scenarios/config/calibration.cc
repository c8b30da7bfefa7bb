#include "scenarios/config/calibration.h"

#include "robot/base/yaml_reader.h"
#include "robot/base/yaml_writer.h"

namespace merlin {

CarCalibration ReadCalibration(const std::filesystem::path& file) {
  CarCalibration calibration;
  YamlFile yaml(file, "a calibration file");
  yaml.Require("", {"wheel_radius_m", "wheelbase_m", "steering_offset_rad"});
  yaml.ReadInto(calibration);
  yaml.ThrowFaults();
  return calibration;
}

MeasuredDrives ReadDrives(const std::filesystem::path& file) {
  MeasuredDrives drives;
  YamlFile yaml(file, "a file of measured drives");
  yaml.Require("", {"straights", "circles"});
  yaml.ReadInto(drives);
  for (std::size_t i = 0; i < drives.straights.size(); ++i)
    yaml.Require("straights[" + std::to_string(i) + "]", {"encoder_counts", "distance_m"});
  for (std::size_t i = 0; i < drives.circles.size(); ++i)
    yaml.Require("circles[" + std::to_string(i) + "]", {"steering_rad", "diameter_m"});
  yaml.ThrowFaults();
  return drives;
}

std::string ToYaml(const CarCalibration& calibration) { return ToYamlText(calibration, 7); }

}  // namespace merlin
