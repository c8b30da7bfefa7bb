#include "scenarios/config/scenario.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"
#include "robot/base/yaml_visitor.h"
#include "scenarios/config/checks_yaml.h"
#include "scenarios/config/names.h"

namespace merlin {
namespace {

YAML::Node Load(const std::filesystem::path& file) {
  try {
    return YAML::LoadFile(file.string());
  } catch (const YAML::BadFile&) {
    throw InputError(file.string(), "cannot be read", "a scenario file");
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ":" + std::to_string(error.mark.line + 1), "broken YAML: " + error.msg);
  }
}

// "a.b=c" onto the tree: c is YAML itself, so numbers, texts and lists work alike.
void Override(YAML::Node root, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("--set", "not an assignment", "key.key=value", "'" + text + "'");
  YAML::Node value;
  try {
    value = YAML::Load(text.substr(equals + 1));
  } catch (const YAML::Exception& error) {
    throw InputError("--set " + text, "broken YAML: " + error.msg);
  }
  YAML::Node node = root;
  std::string path = text.substr(0, equals);
  for (std::size_t dot; (dot = path.find('.')) != std::string::npos; path = path.substr(dot + 1)) {
    const YAML::Node child = node[path.substr(0, dot)];
    if (child.IsDefined() && !child.IsNull() && !child.IsMap())
      throw InputError("--set " + text, "'" + path.substr(0, dot) + "' has no keys below it");
    node.reset(child);
  }
  node[path] = value;
}

// A path in a scenario stands beside it, where there is such a file: so it works from any folder, and so does what is
// written out of it.
void Anchor(std::string& name, const std::filesystem::path& folder) {
  std::error_code ignored;
  const std::filesystem::path beside = folder / name;
  if (name.find('.') != std::string::npos && std::filesystem::is_regular_file(beside, ignored))
    name = std::filesystem::absolute(beside).lexically_normal().string();
}

// A behavior's former name still works, with a warning.
void UseNewName(Scenario& scenario, const std::string& file, std::vector<std::string>& faults) {
  std::string& name = scenario.task.behavior;
  const BehaviorInfo* const behavior = FindBehavior(name);
  if (behavior == nullptr) {
    faults.push_back(file + ": task.behavior: unknown behavior '" + name + "'; did you mean '" +
                     NearestName(name, BehaviorNames()) + "'?");
  } else if (name != behavior->name) {
    scenario.warnings.push_back("the behavior '" + name + "' is now called '" + behavior->name +
                                "': please use the new name in " + file);
    name = behavior->name;
  }
}

}  // namespace

Scenario ReadScenario(const std::string& name, const std::vector<std::string>& overrides) {
  const std::filesystem::path file = ScenarioFile(name);
  YAML::Node root = Load(file);
  if (!root.IsMap()) throw InputError(file.string(), "no scenario", "a map of keys (room, car, sensors, task, ...)");
  for (const std::string& text : overrides) Override(root, text);

  std::set<std::string> sets;
  for (const std::string& text : overrides) sets.insert(text.substr(0, text.find('=')));

  Scenario scenario;
  std::vector<std::string> faults;
  YamlReader(root, file.string(), "", sets, faults).ReadInto(scenario);
  const auto anchor = [&](const char* field, std::string& named) {
    if (!sets.contains(field)) Anchor(named, file.parent_path());
  };
  anchor("room", scenario.room);
  anchor("car.model", scenario.car.model);
  anchor("car.calibration", scenario.car.calibration);
  anchor("sensors.depth.camera", scenario.sensors.depth.camera);
  if (scenario.sensors.color) anchor("sensors.color.camera", scenario.sensors.color->camera);
  if (!root["room"].IsDefined()) faults.push_back(file.string() + ": room: missing; which room to drive in");
  if (scenario.curtain != "open" && scenario.curtain != "closed")
    faults.push_back(file.string() + ": curtain: expected open or closed, got '" + scenario.curtain + "'");
  UseNewName(scenario, file.string(), faults);
  for (const ObstacleEvent& event : scenario.obstacles)
    if (!(event.disappear_s > event.appear_s))
      faults.push_back(file.string() + ": obstacles: one disappears before it appears");
  if (faults.empty()) return scenario;
  std::string all = faults.front();
  for (std::size_t i = 1; i < faults.size(); ++i) all += "\n" + faults[i];
  throw InputError(all);
}

std::string ToYaml(const Scenario& scenario) {
  YAML::Emitter out;
  out.SetDoublePrecision(17);
  Scenario copy = scenario;
  YamlWriter(out).Write(copy);
  return std::string(out.c_str()) + "\n";
}

}  // namespace merlin
