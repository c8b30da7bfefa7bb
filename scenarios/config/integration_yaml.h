// A scenario's integration time, `auto` or a number, from YAML and back (see robot/base/yaml_reader.h).
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "robot/base/yaml_reader.h"
#include "scenarios/config/scenario.h"

namespace merlin {

inline void ReadYaml(YamlReader& reader, const YAML::Node& node, const std::string& field, IntegrationTime& time) {
  time.us.reset();
  if (node.IsScalar() && node.Scalar() == "auto") return;
  double us = 0.0;
  if (node.IsScalar() && YAML::convert<double>::decode(node, us))
    reader.ReadScalar(node, field, time.us.emplace(), {1.0, 1e6});
  else
    reader.Fault(node, field, "expected auto, or a number of microseconds");
}

inline void WriteYaml(YAML::Emitter& out, const IntegrationTime& time) {
  if (time.us)
    out << *time.us;
  else
    out << "auto";
}

}  // namespace merlin
