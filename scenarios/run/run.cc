#include "scenarios/run/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "robot/emulated/emulated_robot.h"
#include "robot/hardware/hardware_robot.h"
#include "scenarios/config/hardware_file.h"
#include "scenarios/config/names.h"
#include "scenarios/judge/output_folder.h"
#include "scenarios/run/drive_loop.h"
#include "scenarios/run/judge_run.h"
#include "scenarios/run/truth.h"
#include "scenarios/run/twin_options.h"

namespace merlin {
namespace {

using WallClock = std::chrono::steady_clock;

constexpr Duration kReady = std::chrono::seconds(10);  // until every device has delivered

double SecondsSince(WallClock::time_point begin) {
  return std::chrono::duration<double>(WallClock::now() - begin).count();
}

// A check of the map against a plan needs a plan.
void RequirePlan(const RunOptions& options, const sim::World& world) {
  for (const CheckLimit& check : options.scenario.checks)
    if (world.plan_xy_m().empty() &&
        (check.name.starts_with("map_size") || check.name.starts_with("laps") || check.name.starts_with("coverage")))
      throw InputError(options.scenario.room, "no plan",
                       "a numeric plan_xy_m, which the check " + check.name + " needs");
}

double PeakRss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Whoever stops reading what we tell does not stop the car.
template <class Progress>
void Tell(const Progress& progress) {
  try {
    progress();
  } catch (const std::exception&) {
  }
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
    Tell([&] { options_.progress(now, distance_m, doing); });
  }

 private:
  const RunOptions& options_;
  const std::atomic<bool>& stop_;
  WallClock::time_point begin_ = WallClock::now(), reported_ = begin_;
};

// What the run's caller is to throw: after the start no InputError is the user's fault, and the twin's devices are
// ours.
std::exception_ptr Blamed(const std::exception_ptr& fault, RobotKind robot) {
  try {
    std::rethrow_exception(fault);
  } catch (const InputError& error) {
    return std::make_exception_ptr(std::runtime_error(error.what()));
  } catch (const DeviceError& error) {
    return robot == RobotKind::kTwin ? std::make_exception_ptr(std::runtime_error(error.what())) : fault;
  } catch (const std::exception&) {
    return fault;
  } catch (...) {
    return std::make_exception_ptr(std::runtime_error("an unknown exception was thrown"));
  }
}

std::string What(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const std::exception& what) {
    return what.what();
  }
}

// A robot, and what its plug knows of it.
struct Plug {
  Robot robot;
  std::function<TrueWorld()> true_world;        // asked once, when the loop is over
  std::function<void(Time stamp)> keep;         // notes the truth at a depth frame's stamp
  std::function<std::string()> car_lost;        // why the truth ends the run; empty: it does not
  std::function<std::string()> complaint = {};  // what the devices say of themselves; may be empty
  std::string gl_name = {}, note = {};
};

// One run of whatever robot: drive, judge, write.
class Session {
 public:
  Session(const RunOptions& options, const CarDescription& car, const std::atomic<bool>& stop)
      : options_(options), stop_(stop), car_(car) {}

  RunReport Drive(const Plug& plug) {
    const Scenario& scenario = options_.scenario;
    const Robot& robot = plug.robot;
    OutputFolder folder(options_.out);
    folder.Write("scenario.yaml", ToYaml(scenario));
    DriveLoop loop(robot, car_, scenario.perception, scenario.slam, scenario.task, scenario.pilot);
    Evidence evidence;
    const double setup_s = SecondsSince(begin_);
    const auto first_step = WallClock::now();
    const Time first = robot.clock->Now();
    Pacer pacer(options_, stop_);
    const LoopObserver observer{
        .depth = [&](const DepthFrame& frame) { evidence.Add(frame), plug.keep(frame.stamp); },
        .color = [&](const ColorFrame& frame) { evidence.Add(frame); },
        .tick = [&](Time now, const Decision& decision) { pacer.Tick(now, loop.slam().path_m(), decision.doing); },
        .hand =
            [&](Time now, const HandStatus& status) {
              if (options_.hand_status) Tell([&] { options_.hand_status(now, status); });
              pacer.Tick(now, loop.slam().path_m(), Name(status.arbitration.driver));
            },
        .car_lost = [&] { return !plug.car_lost().empty(); }};
    FirstFault faults;
    LoopEnd end = LoopEnd::kTimeUp;
    faults.Try([&] { end = loop.Run(stop_, observer, options_.hand); });
    const double wall_s = SecondsSince(first_step);

    RunReport report{
        .result = {.scenario = options_.name, .seed = scenario.seed}, .gl_name = plug.gl_name, .note = plug.note};
    RunResult& result = report.result;
    std::string reason = Reason(end, loop, plug);
    faults.Try([&] { reason = plug.car_lost().empty() ? reason : plug.car_lost(); });
    faults.Try(
        [&] { result = JudgeRun(options_.name, scenario, robot, plug.true_world(), loop, evidence, folder, faults); });
    result.metrics.wall_time_s = wall_s;
    result.metrics.setup_s = setup_s;
    result.metrics.sim_time_s = Seconds(robot.clock->Now() - first);
    result.metrics.real_time_factor = *result.metrics.sim_time_s / wall_s;
    result.metrics.peak_rss_mb = PeakRss_mb();
    result.checks = Evaluate(scenario.checks, result.metrics, options_.name);
    const auto conclude = [&] {
      if (faults.get()) report.error = Blamed(faults.get(), options_.robot);
      result.fault = report.error ? What(report.error) : reason;
      result.verdict = report.error                   ? Verdict::kFail
                       : end == LoopEnd::kInterrupted ? Verdict::kInterrupted
                       : !result.fault.empty()        ? Verdict::kFail
                                                      : Judge(result.checks);
    };
    conclude();
    faults.Try([&] { folder.Write("junit.xml", ToJUnit(result)); });
    conclude();
    faults.Try([&] { folder.Finish(ToJson(result)); });
    conclude();
    return report;
  }

 private:
  // Why the loop ended before its time; empty: it did not, or somebody wished it.
  static std::string Reason(LoopEnd end, const DriveLoop& loop, const Plug& plug) {
    if (end == LoopEnd::kDeviceLost) {
      const std::string complaint = plug.complaint ? plug.complaint() : "";
      return fmt::format("the {} fell silent for a second{}", loop.silent_device(),
                         complaint.empty() ? "" : " (" + complaint + ")");
    }
    if (end == LoopEnd::kBatteryEmpty)
      return fmt::format("the battery is empty: {:.2f} V without the motor, and the car stops below {:.2f} V",
                         loop.energy().rest_v().value_or(0.0), loop.energy().stop_v());
    return "";
  }

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
  return session.Drive({.robot = twin->robot(),
                        .true_world =
                            [&] {
                              return TrueWorld{&twin->world(), &truth, true};
                            },
                        .keep = [&](Time stamp) { truth.Keep(stamp); },
                        .car_lost = [&] { return truth.car_lost(); },
                        .gl_name = twin->gl_name(),
                        .note = WithWarnings(note, twin->world())});
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

std::string Joined(const std::vector<std::string>& sentences, const char* between) {
  std::string joined;
  for (const std::string& sentence : sentences) joined += (joined.empty() ? "" : between) + sentence;
  return joined;
}

void RequireReady(HardwareRobot& robot) {
  const std::string faults = Joined(robot.WaitUntilReady(kReady), "\n");
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
  std::optional<Truth> truth;  // before the robot, whose thread watches it until its end
  std::unique_ptr<EmulatedRobot> emulated;
  HardwareCameras cameras;
  std::string note;
  MakeWithColor(TwinOptionsOf(options.scenario, options), options.scenario, note, [&](const TwinOptions& with) {
    emulated = std::make_unique<EmulatedRobot>(with, sockets.path(), clock);
    cameras = CamerasOf(with);
  });
  const auto locked = [&](const auto& use) { return emulated->With(use); };
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
  const auto car_lost = [&] {
    if (const std::exception_ptr failure = emulated->failure()) std::rethrow_exception(failure);
    return locked([&](Twin&) { return truth->car_lost(); });
  };
  RunReport report = session.Drive({.robot = hardware.robot(),
                                    .true_world = true_world,
                                    .keep = keep,
                                    .car_lost = car_lost,
                                    .complaint = [&] { return Joined(hardware.Complaints(), "; "); },
                                    .gl_name = gl_name,
                                    .note = note});
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
  const auto keep = [&](Time) {
    if (clock.Now() >= end) clock.End();
  };
  return session.Drive({.robot = hardware.robot(),
                        .true_world = [] { return TrueWorld{}; },
                        .keep = keep,
                        .car_lost = [] { return std::string(); },
                        .complaint = [&] { return Joined(hardware.Complaints(), "; "); }});
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
