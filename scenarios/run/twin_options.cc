#include "scenarios/run/twin_options.h"

#include <fmt/format.h>

#include <numbers>
#include <ranges>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"
#include "robot/description/description.h"
#include "scenarios/config/hardware_file.h"
#include "scenarios/config/names.h"

namespace merlin {
namespace {

void RequireRate(const char* field, double rate_hz, double max_hz) {
  if (!(rate_hz <= max_hz))
    throw InputError(field, "faster than the camera", fmt::format("up to {:g} Hz", max_hz),
                     fmt::format("{:g} Hz", rate_hz));
}

void RequireMaterial(const std::string& where, const std::string& name, const sim::Materials& materials) {
  if (name.empty() || materials.by_name.contains(name)) return;
  throw InputError((where.empty() ? "" : where + ": ") +
                   fmt::format("unknown material '{}'; did you mean '{}'?", name,
                               NearestName(name, std::views::keys(materials.by_name))));
}

// The actors with model names resolved to files. Checks that their materials exist.
void AddActors(const Scenario& scenario, const sim::Materials& materials, sim::WorldOptions& world) {
  sim::RefuseFaults(scenario.actors);
  world.obstacles = scenario.obstacles;
  world.actors = scenario.actors;
  for (const sim::ObstacleConfig& obstacle : world.obstacles)
    RequireMaterial(obstacle.where, obstacle.material, materials);
  for (sim::ActorConfig& actor : world.actors) {
    RequireMaterial(actor.where, actor.material, materials);
    if (actor.model.empty()) continue;
    try {
      actor.model = ActorFile(actor.model).string();
    } catch (const InputError& error) {
      throw InputError(actor.where + ": " + error.what());
    }
  }
}

}  // namespace

TwinOptions TwinOptionsOf(const Scenario& scenario, const RunOptions& options) {
  const Sensors& sensors = scenario.sensors;
  TwinOptions twin;
  const CarStart& start = scenario.car.start;
  twin.world = {RoomFile(scenario.room), ReadCar(CarFile(scenario.car.model)),
                FromXyYaw(start.x_m, start.y_m, start.yaw_rad), scenario.curtain == "closed"};
  twin.materials = sim::ReadMaterials(Home() / "models/materials.yaml");
  twin.world.drivetrain = scenario.car.drivetrain;
  if (scenario.car.pan) {
    if (!twin.world.car.pan)
      throw InputError("car.pan", "the car '" + scenario.car.model + "' has no joint that turns its cameras");
    twin.world.car.pan->moves = true;
  }
  if (IsOnTurntable(scenario.task))
    twin.world.turntable_rate_rad_s = scenario.task.rate_deg_s * std::numbers::pi / 180.0;
  twin.seed = scenario.seed;
  const std::filesystem::path depth_file = DepthCameraFile(sensors.depth.camera);
  const DepthCameraSheet sheet = ReadDepthCameraSheet(depth_file);
  twin.depth = {sheet, ReadDepthCameraErrors(depth_file), SettingsOf(sensors.depth, sheet),
                sim::ParseTofEffects(sensors.depth.effects), sensors.depth.rate_hz};
  RequireRate("sensors.depth.rate_hz", sensors.depth.rate_hz, twin.depth.sheet.rate_max_hz);
  RequireRate("sensors.depth.rate_hz", sensors.depth.rate_hz,
              1.0 / twin.depth.sheet.ExposureSpan_s(twin.depth.settings));
  AddActors(scenario, twin.materials, twin.world);
  twin.depth.sheet.latency_s = sensors.depth.latency_s.value_or(twin.depth.sheet.latency_s);
  if (sensors.color && twin.world.car.T_base_color) {
    twin.color.emplace(ReadColorCameraSheet(ColorCameraFile(sensors.color->camera)), sensors.color->rate_hz,
                       options.gl);
    RequireRate("sensors.color.rate_hz", sensors.color->rate_hz, twin.color->sheet.rate_max_hz);
    twin.color->sheet.latency_s = sensors.color->latency_s.value_or(twin.color->sheet.latency_s);
    if (sensors.color->exposure_us)
      twin.color->settings = ColorSettings{.exposure_s = *sensors.color->exposure_us * 1e-6, .auto_exposure = false};
    twin.color->motion_blur = sensors.color->motion_blur;
  }
  if (sensors.compass && twin.world.car.T_base_compass)
    twin.compass.emplace(
        sim::CompassConfig{sensors.compass->noise_rad, sensors.compass->noise_rad, sensors.compass->steel},
        sensors.compass->rate_hz);
  twin.end = FromSeconds(scenario.duration_s);
  twin.threads = options.threads;
  return twin;
}

void MakeWithColor(TwinOptions options, const Scenario& scenario, std::string& note,
                   const std::function<void(const TwinOptions&)>& make) {
  if (!options.color) return make(options);
  const bool required = scenario.sensors.color->required;
  if (options.color->gl == Gl::kOff) {
    if (required) throw MachineError("this scenario needs the colour camera (sensors.color.required), and --gl is off");
    note = "depth only: --gl is off";
    options.color.reset();
    return make(options);
  }
  try {
    return make(options);
  } catch (const MachineError& error) {
    if (required)
      throw MachineError("this scenario needs the colour camera (sensors.color.required): " +
                         std::string(error.what()));
    note = "depth only: " + std::string(error.what());
  }
  options.color.reset();
  make(options);
}

void RequirePlan(const Scenario& scenario, const sim::World& world) {
  for (const CheckLimit& check : scenario.checks)
    if (world.plan_xy_m().empty() &&
        (check.name.starts_with("map_size") || check.name.starts_with("laps") || check.name.starts_with("coverage")))
      throw InputError(scenario.room, "no plan", "a numeric plan_xy_m, which the check " + check.name + " needs");
}

std::vector<std::string> NotesOf(const std::string& without_color, const sim::World& world) {
  std::vector<std::string> notes = world.warnings();
  if (!without_color.empty()) notes.insert(notes.begin(), without_color);
  return notes;
}

}  // namespace merlin
