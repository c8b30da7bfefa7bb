#include "robot/description/car_mapping.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <set>
#include <vector>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"
#include "robot/base/nearest_name.h"
#include "robot/description/drivetrain_numbers.h"

namespace merlin {
namespace {

// One map of the file: every key asked for, none twice, none left over.
class MapReader {
 public:
  MapReader(std::string file, const YAML::Node& map, const std::string& what, FaultList& faults)
      : file_(std::move(file)), map_(map), faults_(faults) {
    if (!map.IsMap()) throw InputError(Where(map), what, "a map of keys");
    std::set<std::string> seen;
    for (const auto& entry : map) {
      if (!entry.first.IsScalar()) throw InputError(Where(entry.first), "a key that is no name");
      if (!seen.insert(entry.first.Scalar()).second)
        faults_.Add({Where(entry.first), fmt::format("'{}' is given twice", entry.first.Scalar())});
    }
  }
  std::string Where(const YAML::Node& node) const { return fmt::format("{}:{}", file_, node.Mark().line + 1); }

  YAML::Node Find(const std::string& key) {
    known_.push_back(key);
    return map_[key];
  }
  // True if the file names a joint or link for that role.
  bool Name(const std::string& role, RoleName& name) {
    const YAML::Node node = Find(role);
    if (!node.IsDefined()) return false;
    if (!node.IsScalar() || node.Scalar().empty())
      faults_.Add({Where(node), fmt::format("'{}'", role), "a name in the URDF"});
    else
      name = {role, node.Scalar(), Where(node)};
    return true;
  }
  std::optional<double> Positive(const std::string& key) {
    const YAML::Node node = Find(key);
    if (!node.IsDefined()) return {};
    double value = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !(value > 0.0) || !std::isfinite(value)) {
      faults_.Add({Where(node), fmt::format("'{}'", key), "a positive number",
                   node.IsScalar() ? node.Scalar() : "no single value"});
      return 1.0;
    }
    return value;
  }
  void RefuseUnknown() {
    for (const auto& entry : map_) {
      const std::string key = entry.first.Scalar();
      if (std::ranges::find(known_, key) == known_.end())
        faults_.Add(
            {Where(entry.first), fmt::format("unknown key '{}'; did you mean '{}'?", key, NearestName(key, known_))});
    }
  }

 private:
  std::string file_;
  YAML::Node map_;
  FaultList& faults_;
  std::vector<std::string> known_;
};

YAML::Node Load(const std::string& file) {
  try {
    return YAML::LoadFile(file);
  } catch (const YAML::BadFile&) {
    throw InputError(file, "cannot be read", "a car's mapping");
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}", file, error.mark.line + 1), "broken YAML: " + error.msg);
  }
}

void ReadCamera(MapReader& reader, const std::string& camera, RoleName& name, FaultList& faults) {
  const bool optical = reader.Name(camera + "_optical_frame", name);
  if (reader.Name(camera + "_frame", name) && optical)
    faults.Add({name.where, fmt::format("'{0}_frame' beside '{0}_optical_frame'", camera), "one of them"});
}

Drivetrain ReadDrivetrain(const std::string& file, const YAML::Node& node, FaultList& faults) {
  MapReader reader(file, node, "'drivetrain'", faults);
  const Drivetrain drivetrain = DrivetrainOf(reader.Where(node), "drivetrain", [&](const std::string& name) {
    const std::optional<double> value = reader.Positive(name);
    if (!value) throw InputError(reader.Where(node), fmt::format("drivetrain needs '{}'", name));
    return *value;
  });
  reader.RefuseUnknown();
  return drivetrain;
}

void ReadRoles(MapReader& reader, CarMapping& mapping, FaultList& faults) {
  for (RoleName& joint : mapping.wheel_joints) reader.Name(joint.role, joint);
  for (RoleName& joint : mapping.steer_joints) reader.Name(joint.role, joint);
  ReadCamera(reader, "depth_camera", mapping.depth_camera, faults);
  ReadCamera(reader, "color_camera", mapping.color_camera, faults);
  reader.Name("compass_frame", mapping.compass);
  reader.Name("pan_joint", mapping.pan_joint);
}

}  // namespace

std::filesystem::path MappingFile(const std::filesystem::path& urdf) {
  return std::filesystem::path(urdf).replace_extension(".mapping.yaml");
}

CarMapping ReadMapping(const std::filesystem::path& urdf) {
  CarMapping mapping;
  const std::string file = MappingFile(urdf).string();
  if (!std::filesystem::exists(file)) return mapping;
  mapping.has_file = true;
  FaultList faults;
  faults.Try([&] {
    MapReader reader(file, Load(file), "no mapping", faults);
    ReadRoles(reader, mapping, faults);
    mapping.steering_limit_rad = reader.Positive("steering_limit_rad");
    mapping.wheel_radius_m = reader.Positive("wheel_radius_m");
    mapping.wheel_width_m = reader.Positive("wheel_width_m");
    const YAML::Node drivetrain = reader.Find("drivetrain");
    reader.RefuseUnknown();
    if (drivetrain.IsDefined()) mapping.drivetrain = ReadDrivetrain(file, drivetrain, faults);
  });
  faults.ThrowIfAny();
  return mapping;
}

}  // namespace merlin
