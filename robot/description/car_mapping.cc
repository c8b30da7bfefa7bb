#include "robot/description/car_mapping.h"

#include "robot/base/yaml_reader.h"
#include "robot/description/drivetrain_numbers.h"

namespace merlin {
namespace {

// Takes the name that the file gives to a role; false where it gives none.
bool Name(YamlReader& reader, const std::string& role, RoleName& name) {
  std::string text;
  reader(role.c_str(), text);
  const YamlEntry* entry = reader.Find(role);
  if (entry == nullptr) return false;
  if (entry->value.IsScalar() && text.empty()) reader.Fault(entry->value, role, "expected a name in the URDF");
  name = {role, text, reader.Where(entry->value, role)};
  return true;
}

void ReadCamera(YamlReader& reader, const std::string& camera, RoleName& name) {
  const std::string optical = camera + "_optical_frame", level = camera + "_frame";
  const bool has_optical = Name(reader, optical, name);
  if (Name(reader, level, name) && has_optical)
    reader.Fault(reader.Find(level)->value, level, "stands beside '" + optical + "'; expected one of them");
}

void ReadRoles(YamlReader& reader, CarMapping& mapping) {
  for (RoleName& joint : mapping.wheel_joints) Name(reader, joint.role, joint);
  for (RoleName& joint : mapping.steer_joints) Name(reader, joint.role, joint);
  ReadCamera(reader, "depth_camera", mapping.depth_camera);
  ReadCamera(reader, "color_camera", mapping.color_camera);
  Name(reader, "compass_frame", mapping.compass);
  Name(reader, "pan_joint", mapping.pan_joint);
}

}  // namespace

void ReadYaml(YamlReader& reader, const YAML::Node& node, const std::string& field, Drivetrain& drivetrain) {
  YamlReader map(reader.file(), node, field);
  EachDrivetrainNumber(drivetrain,
                       [&map](const char* name, auto& value, Range range) { map.Need(name, value, range); });
  map.RefuseUnknown();
}

std::filesystem::path MappingFile(const std::filesystem::path& urdf) {
  return std::filesystem::path(urdf).replace_extension(".mapping.yaml");
}

CarMapping ReadMapping(const std::filesystem::path& urdf) {
  CarMapping mapping;
  const std::string file = MappingFile(urdf).string();
  if (!std::filesystem::exists(file)) return mapping;
  mapping.has_file = true;
  YamlFile yaml(file, "a car's mapping");
  YamlReader reader(yaml, yaml.root(), "");
  ReadRoles(reader, mapping);
  reader("steering_limit_rad", mapping.steering_limit_rad, kPositive);
  reader("wheel_radius_m", mapping.wheel_radius_m, kPositive);
  reader("wheel_width_m", mapping.wheel_width_m, kPositive);
  reader("drivetrain", mapping.drivetrain);
  reader.RefuseUnknown();
  yaml.ThrowFaults();
  return mapping;
}

}  // namespace merlin
