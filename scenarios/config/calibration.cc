#include "scenarios/config/calibration.h"

#include "robot/base/error.h"
#include "robot/base/yaml_file.h"

namespace merlin {

CarCalibration ReadCalibration(const std::filesystem::path& file) {
  CarCalibration calibration;
  YamlFile yaml(file, "a calibration file");
  yaml.Require({"wheel_radius_m", "wheelbase_m", "steering_offset_rad"});
  yaml.ReadInto(calibration);
  return calibration;
}

MeasuredDrives ReadDrives(const std::filesystem::path& file) {
  MeasuredDrives drives;
  YamlFile yaml(file, "a file of measured drives");
  yaml.Require({"straights", "circles"});
  yaml.ReadInto(drives);
  // A key that a drive lacks was left at zero, which is outside its range, or no circle.
  std::string faults;
  const auto check = [&](const char* list, auto& all, auto lacks) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (const char* key = lacks(all[i]))
        faults += (faults.empty() ? "" : "\n") + file.string() + ": " + list + "[" + std::to_string(i) +
                  "]: missing key '" + key + "'";
  };
  check("straights", drives.straights, [](const StraightDrive& d) {
    return d.encoder_counts == 0 ? "encoder_counts" : d.distance_m == 0.0 ? "distance_m" : nullptr;
  });
  check("circles", drives.circles, [](const CircleDrive& d) {
    return d.steering_rad == 0.0 ? "steering_rad" : d.diameter_m == 0.0 ? "diameter_m" : nullptr;
  });
  if (!faults.empty()) throw InputError(faults);
  return drives;
}

std::string ToYaml(const CarCalibration& calibration) {
  YAML::Emitter out;
  out.SetDoublePrecision(7);
  CarCalibration copy = calibration;
  YamlWriter(out).Write(copy);
  return std::string(out.c_str()) + "\n";
}

}  // namespace merlin
