#include "scenarios/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "robot/description/description.h"
#include "robot/hardware/hardware_robot.h"
#include "robot/twin/devices/emulated_robot.h"
#include "robot/types/error.h"
#include "scenarios/drive_loop.h"
#include "scenarios/hardware_file.h"
#include "scenarios/judge/output_folder.h"
#include "scenarios/judge_run.h"
#include "scenarios/names.h"
#include "scenarios/truth.h"
#include "scenarios/twin_options.h"

namespace merlin {
namespace {

using WallClock = std::chrono::steady_clock;

constexpr Duration kReady = std::chrono::seconds(10);  // until every device has delivered

double SecondsSince(WallClock::time_point begin) { return std::chrono::duration<double>(WallClock::now() - begin).count(); }

// A check of the map against a plan needs a plan.
void RequirePlan(const RunOptions& options, const sim::World& world) {
  for (const CheckLimit& check : options.scenario.checks)
    if (world.plan_xy_m().empty() && (check.name.starts_with("map_size") || check.name.starts_with("laps") || check.name.starts_with("coverage")))
      throw InputError(options.scenario.room, "no plan", "a numeric plan_xy_m, which the check " + check.name + " needs");
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

// One run of whatever robot: drive, judge, write.
class Session {
 public:
  Session(const RunOptions& options, const CarDescription& car, const std::atomic<bool>& stop)
      : options_(options), stop_(stop), car_(car) {}

  // keep: notes the truth at a stamp. time: of the world, or of the clock where there is none.
  RunReport Drive(const Robot& robot, const std::function<TrueWorld()>& true_world, const std::function<void(Time)>& keep,
                  const std::string& gl_name, const std::string& note) {
    const Scenario& scenario = options_.scenario;
    OutputFolder folder(options_.out);
    folder.Write("scenario.yaml", ToYaml(scenario));
    DriveLoop loop(robot, car_, scenario.perception, scenario.slam, scenario.task, scenario.pilot);
    Evidence evidence;
    const double setup_s = SecondsSince(begin_);
    const auto first_step = WallClock::now();
    const Time first = robot.clock->Now();
    Pacer pacer(options_, stop_);
    const LoopEnd end = loop.Run(
        stop_, {.depth = [&](const DepthFrame& frame) { evidence.Add(frame), keep(frame.stamp); },
                .color = [&](const ColorFrame& frame) { evidence.Add(frame); },
                .tick = [&](Time now, const Decision& decision) { pacer.Tick(now, loop.slam().path_m(), decision.doing); },
                .hand = [&](Time now, const HandStatus& status) {
                  if (options_.hand_status) options_.hand_status(now, status);
                  pacer.Tick(now, loop.slam().path_m(), Name(status.arbitration.driver));
                }},
        options_.hand);
    const double wall_s = SecondsSince(first_step);

    RunReport report{.result = JudgeRun(options_.name, scenario, robot, true_world(), loop, evidence, folder),
                     .gl_name = gl_name,
                     .note = note};
    RunResult& result = report.result;
    result.metrics.wall_time_s = wall_s;
    result.metrics.setup_s = setup_s;
    result.metrics.sim_time_s = Seconds(robot.clock->Now() - first);
    result.metrics.real_time_factor = *result.metrics.sim_time_s / wall_s;
    result.metrics.peak_rss_mb = PeakRss_mb();
    result.checks = Evaluate(scenario.checks, result.metrics, options_.name);
    if (end == LoopEnd::kDeviceLost) result.fault = "the depth camera or the drive fell silent for a second";
    if (end == LoopEnd::kBatteryEmpty)
      result.fault = fmt::format("the battery is empty: {:.2f} V without the motor, and the car stops below {:.2f} V",
                                 loop.energy().rest_v().value_or(0.0), loop.energy().stop_v());
    result.verdict = end == LoopEnd::kInterrupted ? Verdict::kInterrupted
                     : !result.fault.empty()     ? Verdict::kFail
                                                 : Judge(result.checks);
    folder.Write("junit.xml", ToJUnit(result));
    folder.Finish(ToJson(result));
    return report;
  }

 private:
  const RunOptions& options_;
  const std::atomic<bool>& stop_;
  const CarDescription& car_;
  WallClock::time_point begin_ = WallClock::now();
};

// The sentences of a note, and those that the room asks for.
std::string WithWarnings(std::string note, const sim::World& world) {
  for (const std::string& warning : world.warnings()) note += (note.empty() ? "" : "; ") + warning;
  return note;
}

RunReport RunInTwin(const RunOptions& options, const CarDescription& car, const std::atomic<bool>& stop) {
  Session session(options, car, stop);
  std::unique_ptr<Twin> twin;
  std::string note;
  MakeWithColor(TwinOptionsOf(options.scenario, options), options.scenario, note,
                [&](const TwinOptions& with) { twin = std::make_unique<Twin>(with); });
  RequirePlan(options, twin->world());
  Truth truth(options.scenario, twin->world());
  twin->OnStep([&truth](sim::World& world) { truth.Watch(world); });
  return session.Drive(
      twin->robot(), [&] { return TrueWorld{&twin->world(), &truth, true}; }, [&](Time stamp) { truth.Keep(stamp); },
      twin->gl_name(), WithWarnings(note, twin->world()));
}

// A folder of this run's own for the devices' sockets, gone with it.
class SocketFolder {
 public:
  SocketFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "merlin-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw MachineError(name + ": cannot make a folder for the devices' sockets");
    path_ = name;
  }
  ~SocketFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// The emulated ToF camera's library, as this program was built with it; MERLIN_PMD_LIBRARY names another.
std::string PmdLibrary() {
  const char* other = std::getenv("MERLIN_PMD_LIBRARY");
  return other != nullptr ? other : MERLIN_PMD_LIBRARY;
}

HardwareConfig DevicesOf(const EmulatedRobot& emulated) {
  HardwareConfig config;
  config.drive.serial = {emulated.drive_port(), EmulatedRobot::kDriveBaud};
  if (const auto port = emulated.compass_port()) config.compass.emplace().serial = {*port, 9600};
  config.depth.pmd.library = PmdLibrary();
  config.depth.pmd.source_argument = emulated.depth_socket();
  if (const auto url = emulated.color_url()) {
    config.color.emplace().source = *url;
    config.color->stream_latency_s = EmulatedRobot::kStreamLatency_s;
  }
  return config;
}

void RequireReady(HardwareRobot& robot) {
  std::string faults;
  for (const std::string& complaint : robot.WaitUntilReady(kReady)) faults += (faults.empty() ? "" : "\n") + complaint;
  if (!faults.empty()) throw MachineError(faults);
}

HardwareCameras CamerasOf(const TwinOptions& twin) {
  HardwareCameras cameras{.depth = {twin.depth.sheet, twin.world.car.T_base_depth, twin.depth.rate_hz},
                          .depth_settings = twin.depth.settings};
  if (twin.color) {
    cameras.color = {twin.color->sheet, twin.world.car.T_base_color.value(), twin.color->rate_hz};
    cameras.color_settings = twin.color->settings.value_or(DefaultSettings(twin.color->sheet));
  }
  return cameras;
}

RunReport RunEmulated(const RunOptions& options, const CarDescription& car, const std::atomic<bool>& stop) {
  Session session(options, car, stop);
  const SocketFolder sockets;
  RealClock clock({}, Time::max());
  std::unique_ptr<EmulatedRobot> emulated;
  HardwareCameras cameras;
  std::string note;
  MakeWithColor(TwinOptionsOf(options.scenario, options), options.scenario, note, [&](const TwinOptions& with) {
    emulated = std::make_unique<EmulatedRobot>(with, sockets.path(), clock);
    cameras = CamerasOf(with);
  });
  const auto locked = [&](const auto& use) { return emulated->With(use); };
  std::optional<Truth> truth;
  std::string gl_name;
  locked([&](Twin& twin) {
    RequirePlan(options, twin.world());
    truth.emplace(options.scenario, twin.world());
    twin.OnStep([&truth](sim::World& world) { truth->Watch(world); });
    gl_name = twin.gl_name();
    note = WithWarnings(note, twin.world());
  });
  emulated->Start();
  HardwareRobot hardware(DevicesOf(*emulated), cameras, clock);
  RequireReady(hardware);
  const auto true_world = [&] {
    emulated->Stop();
    return locked([&](Twin& twin) { return TrueWorld{&twin.world(), &*truth, false}; });
  };
  const Time end = clock.Now() + FromSeconds(options.scenario.duration_s);
  const auto keep = [&](Time stamp) {
    locked([&](Twin&) { truth->Keep(stamp); });
    if (clock.Now() >= end) clock.End();
  };
  RunReport report = session.Drive(hardware.robot(), true_world, keep, gl_name, note);
  if (emulated->lag() > std::chrono::milliseconds(100))
    report.note += fmt::format("{}the world fell {:.0f} ms behind the clock: this machine was too slow at times",
                               report.note.empty() ? "" : "; ", 1e3 * Seconds(emulated->lag()));
  return report;
}

RunReport RunOnHardware(const RunOptions& options, const CarDescription& car, const std::atomic<bool>& stop) {
  Session session(options, car, stop);
  const HardwareConfig config = ReadHardwareFile(options.hardware_file);
  HardwareCameras cameras = CamerasOf(options.scenario);
  RealClock clock(config.clock, Time::max());
  HardwareRobot hardware(config, cameras, clock);
  RequireReady(hardware);
  const Time end = clock.Now() + FromSeconds(options.scenario.duration_s);
  return session.Drive(
      hardware.robot(), [] { return TrueWorld{}; },
      [&](Time) {
        if (clock.Now() >= end) clock.End();
      },
      "", "");
}

RunReport RunWith(const RunOptions& options, const CarDescription& car, const std::atomic<bool>& stop) {
  switch (options.robot) {
    case RobotKind::kEmulated:
      return RunEmulated(options, car, stop);
    case RobotKind::kHardware:
      return RunOnHardware(options, car, stop);
    default:
      return RunInTwin(options, car, stop);
  }
}

}  // namespace

RunReport RunScenario(const RunOptions& asked, const std::atomic<bool>& stop) {
  if (IsOnStand(asked.scenario.task) && (asked.robot != RobotKind::kTwin || asked.hand))
    throw InputError("task.behavior", "turn_on_stand: only the twin has a stand, and nobody drives on it",
                     "merlin run with --robot twin");
  const CarDescription car = BelievedCar(asked.scenario.car);
  std::vector<std::string> warnings = car.warnings;
  RunOptions options = asked;
  LeaveOutWhatTheCarLacks(car, options.scenario.sensors, warnings);
  RunReport report = RunWith(options, car, stop);
  for (const std::string& warning : warnings) report.note += (report.note.empty() ? "" : "; ") + warning;
  return report;
}

}  // namespace merlin
