// A scenario's checks, "name: limit" each, from YAML and back (see robot/base/yaml_reader.h).
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "robot/base/yaml_reader.h"
#include "scenarios/judge/checks.h"

namespace merlin {

inline void ReadYaml(YamlReader& reader, const YAML::Node& node, const std::string& field,
                     std::vector<CheckLimit>& checks) {
  checks.clear();
  for (const YamlEntry& entry : reader.file().Entries(node, field)) {
    CheckLimit check{entry.key, 0.0};
    const std::string name = field + "." + check.name;
    reader.ReadScalar(entry.value, name, check.limit, {-1e12, 1e12});
    checks.push_back(check);
    try {
      RequireKnown(check, reader.Where(entry.key_node, name));
    } catch (const InputError& error) {
      reader.Add(error);
    }
  }
}

inline void WriteYaml(YAML::Emitter& out, const std::vector<CheckLimit>& checks) {
  out << YAML::BeginMap;
  for (const CheckLimit& check : checks) out << YAML::Key << check.name << YAML::Value << check.limit;
  out << YAML::EndMap;
}

}  // namespace merlin
