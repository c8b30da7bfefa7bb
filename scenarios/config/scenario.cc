#include "scenarios/config/scenario.h"

#include <algorithm>

#include "robot/base/nearest_name.h"
#include "robot/base/yaml_reader.h"
#include "robot/base/yaml_writer.h"
#include "scenarios/config/checks_yaml.h"
#include "scenarios/config/integration_yaml.h"
#include "scenarios/config/names.h"

namespace merlin {
namespace {

// Turns a path relative to the scenario's folder into an absolute one, if there is such a file. The scenario then works
// from any current folder, and so does the scenario.yaml written from it.
void Anchor(std::string& name, const std::filesystem::path& folder) {
  std::error_code ignored;
  const std::filesystem::path beside = folder / name;
  if (name.find('.') != std::string::npos && std::filesystem::is_regular_file(beside, ignored))
    name = std::filesystem::absolute(beside).lexically_normal().string();
}

// The former name of a behavior still works, with a warning.
void UseNewName(Scenario& scenario, const std::string& file, YamlFile& yaml) {
  std::string& name = scenario.task.behavior;
  const BehaviorInfo* const behavior = FindBehavior(name);
  if (behavior == nullptr) {
    yaml.Fault("task.behavior",
               "unknown behavior '" + name + "'; did you mean '" + NearestName(name, BehaviorNames()) + "'?");
  } else if (name != behavior->name) {
    scenario.warnings.push_back("the behavior '" + name + "' is now called '" + behavior->name +
                                "': please use the new name in " + file);
    name = behavior->name;
  }
}

// Reports a key that no longer exists together with its replacement.
void RefuseFormerKey(YamlFile& yaml) {
  YAML::Node node = YAML::Clone(yaml.root());
  for (const char* key : {"perception", "integration", "adapt"}) {
    if (!node.IsMap() || !node[key]) return;
    node.reset(node[key]);
  }
  yaml.Fault("perception.integration.adapt", "is gone: write sensors.depth.integration_us: auto, or a number");
  yaml.ThrowFaults();
}

// Rules that the range of a single value cannot express.
void CheckRules(const Scenario& scenario, YamlFile& yaml) {
  if (scenario.curtain != "open" && scenario.curtain != "closed")
    yaml.Fault("curtain", "expected open or closed, got '" + scenario.curtain + "'");
  for (std::size_t i = 0; i < scenario.obstacles.size(); ++i)
    if (!(scenario.obstacles[i].disappear_s > scenario.obstacles[i].appear_s))
      yaml.Fault("obstacles[" + std::to_string(i) + "].disappear_s", "expected a time after its appear_s");
}

}  // namespace

Scenario ReadScenario(const std::string& name, const std::vector<std::string>& overrides) {
  const std::filesystem::path file = ScenarioFile(name);
  YamlFile yaml(file, "a scenario: room, car, sensors, task, ...");
  for (const std::string& text : overrides) yaml.Set(text);
  Scenario scenario;
  yaml.Require("", {"room"});
  RefuseFormerKey(yaml);
  yaml.ReadInto(scenario);
  const auto anchor = [&](const char* field, std::string& named) {
    if (!yaml.IsSet(field)) Anchor(named, file.parent_path());
  };
  const auto where = [&](const char* list, std::size_t i) {
    return yaml.Where(yaml.root()[list][i], list + ("[" + std::to_string(i) + "]"));
  };
  for (std::size_t i = 0; i < scenario.obstacles.size(); ++i) scenario.obstacles[i].where = where("obstacles", i);
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    scenario.actors[i].where = where("actors", i);
    anchor("actors", scenario.actors[i].model);
  }
  anchor("room", scenario.room);
  anchor("car.model", scenario.car.model);
  anchor("map", scenario.map);
  anchor("car.calibration", scenario.car.calibration);
  anchor("sensors.depth.camera", scenario.sensors.depth.camera);
  if (scenario.sensors.color) anchor("sensors.color.camera", scenario.sensors.color->camera);
  UseNewName(scenario, file.string(), yaml);
  CheckRules(scenario, yaml);
  scenario.perception.integration.automatic = !scenario.sensors.depth.integration_us.us;
  yaml.ThrowFaults();
  return scenario;
}

std::string ToYaml(const Scenario& scenario) { return ToYamlText(scenario, 17); }

}  // namespace merlin
