#include "scenarios/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <memory>
#include <ranges>
#include <thread>

#include "robot/description/description.h"
#include "robot/twin/twin.h"
#include "robot/types/error.h"
#include "robot/types/nearest_name.h"
#include "scenarios/calibration.h"
#include "scenarios/drive_loop.h"
#include "scenarios/judge_run.h"
#include "scenarios/judge/output_folder.h"
#include "scenarios/names.h"
#include "scenarios/truth.h"

namespace merlin {
namespace {

using WallClock = std::chrono::steady_clock;

double SecondsSince(WallClock::time_point begin) { return std::chrono::duration<double>(WallClock::now() - begin).count(); }

void RequireRate(const char* field, double rate_hz, double max_hz) {
  if (!(rate_hz <= max_hz)) throw InputError(field, "faster than the camera", fmt::format("up to {:g} Hz", max_hz), fmt::format("{:g} Hz", rate_hz));
}

void RequireMaterial(const std::string& name, const sim::Materials& materials) {
  if (materials.by_name.contains(name)) return;
  throw InputError("obstacles", fmt::format("unknown material '{}'; did you mean '{}'?", name,
                                            NearestName(name, std::views::keys(materials.by_name))));
}

DepthSettings SettingsOf(const DepthSensor& sensor) {
  return {.integration_s = sensor.integration_us * 1e-6,
          .frequency_hz = sensor.frequency_mhz * 1e6,
          .second_frequency_hz = sensor.second_frequency_mhz * 1e6,
          .post_processing = sensor.post_processing};
}

TwinOptions TwinOptionsOf(const Scenario& scenario, const RunOptions& options) {
  const Sensors& sensors = scenario.sensors;
  TwinOptions twin;
  const CarStart& start = scenario.car.start;
  twin.world = {RoomFile(scenario.room), ReadCar(CarFile(scenario.car.model)), FromXyYaw(start.x_m, start.y_m, start.yaw_rad),
                ObstaclesOf(scenario), scenario.curtain == "closed"};
  twin.materials = sim::ReadMaterials(Home() / "models/materials.yaml");
  twin.world.drivetrain = scenario.car.drivetrain;
  twin.seed = scenario.seed;
  const std::filesystem::path depth_file = DepthCameraFile(sensors.depth.camera);
  twin.depth = {ReadDepthCameraSheet(depth_file), ReadDepthCameraErrors(depth_file), SettingsOf(sensors.depth),
                sim::ParseTofEffects(sensors.depth.effects), sensors.depth.rate_hz};
  RequireRate("sensors.depth.rate_hz", sensors.depth.rate_hz, twin.depth.sheet.rate_max_hz);
  RequireRate("sensors.depth.rate_hz", sensors.depth.rate_hz, 1.0 / twin.depth.sheet.ExposureSpan_s(twin.depth.settings));
  for (const ObstacleEvent& event : scenario.obstacles) RequireMaterial(event.material, twin.materials);
  twin.depth.sheet.latency_s = sensors.depth.latency_s.value_or(twin.depth.sheet.latency_s);
  if (sensors.color) {
    twin.color.emplace(ReadColorCameraSheet(ColorCameraFile(sensors.color->camera)), sensors.color->rate_hz, options.gl);
    RequireRate("sensors.color.rate_hz", sensors.color->rate_hz, twin.color->sheet.rate_max_hz);
    twin.color->sheet.latency_s = sensors.color->latency_s.value_or(twin.color->sheet.latency_s);
    if (sensors.color->exposure_us)
      twin.color->settings = ColorSettings{.exposure_s = *sensors.color->exposure_us * 1e-6, .auto_exposure = false};
    twin.color->motion_blur = sensors.color->motion_blur;
  }
  if (sensors.compass)
    twin.compass.emplace(sim::CompassConfig{sensors.compass->noise_rad, sensors.compass->noise_rad}, sensors.compass->rate_hz);
  twin.end = FromSeconds(scenario.duration_s);
  twin.threads = options.threads;
  return twin;
}

// The car as the stack knows it: its description, and what a calibration found better.
CarDescription BelievedCar(const CarChoice& choice) {
  const CarDescription car = ReadCar(CarFile(choice.model));
  return choice.calibration.empty() ? car : Calibrated(car, ReadCalibration(choice.calibration));
}

// A check of the map against a plan needs a plan.
void RequirePlan(const RunOptions& options, const sim::World& world) {
  for (const CheckLimit& check : options.scenario.checks)
    if (world.plan_xy_m().empty() && (check.name.starts_with("map_size") || check.name.starts_with("laps") || check.name.starts_with("coverage")))
      throw InputError(options.scenario.room, "no plan", "a numeric plan_xy_m, which the check " + check.name + " needs");
}

// Without GL a scenario that can do without colour runs on depth alone, and says so.
std::unique_ptr<Twin> MakeTwin(TwinOptions twin, const Scenario& scenario, std::string& note) {
  if (!twin.color) return std::make_unique<Twin>(twin);
  const bool required = scenario.sensors.color->required;
  if (twin.color->gl == sim::Gl::kOff) {
    if (required) throw MachineError("this scenario needs the colour camera (sensors.color.required), and --gl is off");
    note = "depth only: --gl is off";
    twin.color.reset();
    return std::make_unique<Twin>(twin);
  }
  try {
    return std::make_unique<Twin>(twin);
  } catch (const MachineError& error) {
    if (required) throw MachineError("this scenario needs the colour camera (sensors.color.required): " + std::string(error.what()));
    note = "depth only: " + std::string(error.what());
  }
  twin.color.reset();
  return std::make_unique<Twin>(twin);
}

double PeakRss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Holds the run back to the wall's pace, and reports progress now and then.
class Pacer {
 public:
  Pacer(const RunOptions& options, const std::atomic<bool>& stop) : options_(options), stop_(stop) {}
  void Tick(Time now, double distance_m, const std::string& doing) {
    while (options_.pace > 0.0 && !stop_.load()) {
      const double ahead_s = Seconds(now) / options_.pace - SecondsSince(begin_);
      if (ahead_s <= 0.0) break;
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(ahead_s, 0.05)));  // Ctrl-C must not wait
    }
    if (!options_.progress || SecondsSince(reported_) < 0.2) return;
    reported_ = WallClock::now();
    options_.progress(now, distance_m, doing);
  }

 private:
  const RunOptions& options_;
  const std::atomic<bool>& stop_;
  WallClock::time_point begin_ = WallClock::now(), reported_ = begin_;
};

}  // namespace

RunReport RunScenario(const RunOptions& options, const std::atomic<bool>& stop) {
  const auto begin = WallClock::now();
  const Scenario& scenario = options.scenario;
  RunReport report;
  const CarDescription car = BelievedCar(scenario.car);
  const std::unique_ptr<Twin> twin = MakeTwin(TwinOptionsOf(scenario, options), scenario, report.note);
  RequirePlan(options, twin->world());
  OutputFolder folder(options.out);
  folder.Write("scenario.yaml", ToYaml(scenario));
  report.gl_name = twin->gl_name();

  Truth truth(scenario, twin->world());
  twin->OnStep([&truth](sim::World& world) { truth.Watch(world); });
  DriveLoop loop(twin->robot(), car, scenario.perception, scenario.slam, scenario.task, scenario.pilot);
  Evidence evidence;
  const double setup_s = SecondsSince(begin);
  const auto first_step = WallClock::now();
  Pacer pacer(options, stop);
  const LoopEnd end = loop.Run(
      stop, {.depth = [&](const DepthFrame& frame) { evidence.Add(frame), truth.Keep(frame.stamp); },
             .color = [&](const ColorFrame& frame) { evidence.Add(frame); },
             .tick = [&](Time now, const Decision& decision) { pacer.Tick(now, loop.slam().path_m(), decision.doing); }});
  const double wall_s = SecondsSince(first_step);

  RunResult& result = report.result;
  result = JudgeRun(options.name, scenario, *twin, truth, loop, evidence, folder);
  result.metrics.wall_time_s = wall_s;
  result.metrics.setup_s = setup_s;
  result.metrics.sim_time_s = Seconds(twin->world().Now());
  result.metrics.real_time_factor = *result.metrics.sim_time_s / wall_s;
  result.metrics.peak_rss_mb = PeakRss_mb();
  result.checks = Evaluate(scenario.checks, result.metrics, options.name);
  if (end == LoopEnd::kDeviceLost) result.fault = "the depth camera or the drive fell silent for a second";
  result.verdict = end == LoopEnd::kInterrupted ? Verdict::kInterrupted
                   : end == LoopEnd::kDeviceLost ? Verdict::kFail
                                                 : Judge(result.checks);
  folder.Write("junit.xml", ToJUnit(result));
  folder.Finish(ToJson(result));
  return report;
}

}  // namespace merlin
