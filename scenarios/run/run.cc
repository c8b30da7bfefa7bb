#include "scenarios/run/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "robot/base/error.h"
#include "scenarios/config/believed_car.h"
#include "scenarios/judge/frame_hashes.h"
#include "scenarios/judge/measure.h"
#include "scenarios/judge/output_folder.h"
#include "scenarios/judge/write.h"
#include "scenarios/run/pacer.h"
#include "scenarios/run/versions.h"

namespace merlin {
namespace {

double PeakRss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Converts an exception to the type that the caller is to throw. After the start an InputError is not the user's fault,
// and a failing device of a simulated world that waits for us is a fault of this program.
std::exception_ptr Blamed(const std::exception_ptr& fault, const PlugTraits& traits) {
  try {
    std::rethrow_exception(fault);
  } catch (const InputError& error) {
    return std::make_exception_ptr(std::runtime_error(error.what()));
  } catch (const DeviceError& error) {
    return traits.world_waits ? std::make_exception_ptr(std::runtime_error(error.what())) : fault;
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

std::string Joined(const std::vector<std::string>& sentences) {
  std::string joined;
  for (const std::string& sentence : sentences) joined += (joined.empty() ? "" : "; ") + sentence;
  return joined;
}

// How the loop ended.
struct Ending {
  LoopEnd end = LoopEnd::kTimeUp;
  std::string reason;  // why it ended early; empty if it did not, or on request
};

// One run of any robot: drive, judge, write.
class Session {
 public:
  Session(const RunOptions& options, Plug& plug, const CarDescription& car, std::optional<SavedMap> former,
          double setup_s, const std::atomic<bool>& stop)
      : options_(options),
        plug_(plug),
        robot_(plug.robot()),
        stop_(stop),
        folder_(options.out),
        loop_(robot_, car, options.scenario.perception, options.scenario.slam, options.scenario.task,
              options.scenario.pilot, std::move(former)) {
    folder_.Write("scenario.yaml", ToYaml(options.scenario));
    figures_.setup_s = setup_s;
  }

  RunReport Run() {
    const Ending ending = Drive();
    RunReport report;
    report.result = Judged();
    Conclude(ending, report);
    faults_.Try([&] { folder_.Write("junit.xml", ToJUnit(report.result)); });
    Conclude(ending, report);
    faults_.Try([&] { folder_.Finish(ToJson(report.result)); });
    Conclude(ending, report);
    report.gl_name = plug_.renderer();
    std::vector<std::string> notes = plug_.notes();
    for (const Outage& outage : loop_.state().outages) notes.push_back(outage.Sentence(loop_.state().began));
    report.note = Joined(notes);
    return report;
  }

 private:
  Ending Drive() {
    const WallClock::time_point begin = WallClock::now();
    const Time first = robot_.clock->Now();
    Pacer pacer(options_, stop_);
    const LoopObserver observer = [&](const LoopState& state) {
      for (const auto& frame : state.heard.depth) frames_.Add(*frame), plug_.Keep(frame->stamp);
      for (const auto& frame : state.heard.color) frames_.Add(*frame);
      if (options_.station) Tell([&] { options_.station(state); });
      pacer.Tick(state);
      return plug_.ReasonToEnd().empty();
    };
    Ending ending;
    faults_.Try([&] { ending.end = loop_.Run(stop_, observer, options_.manual); });
    figures_.wall_time_s = SecondsSince(begin);
    figures_.sim_time_s = Seconds(robot_.clock->Now() - first);
    figures_.real_time_factor = *figures_.sim_time_s / *figures_.wall_time_s;
    ending.reason = Reason(ending.end);
    faults_.Try([&] {
      if (const std::string reason = plug_.ReasonToEnd(); !reason.empty()) ending.reason = reason;
    });
    return ending;
  }

  std::string Reason(LoopEnd end) const {
    if (end == LoopEnd::kDeviceLost) {
      const std::string complaints = Joined(plug_.Complaints());
      return loop_.state().stop + (complaints.empty() ? "" : " (" + complaints + ")");
    }
    if (end == LoopEnd::kGivesUp) return loop_.state().decision->gives_up;
    if (end == LoopEnd::kBatteryEmpty)
      return fmt::format("the battery is empty: {:.2f} V without the motor, and the car stops below {:.2f} V",
                         loop_.energy().rest_v().value_or(0.0), loop_.energy().stop_v());
    return ReasonOfSearch(end);
  }

  // Why a car that was to start in a map is not known to be in it. With an operator nobody waits for that.
  std::string ReasonOfSearch(LoopEnd end) const {
    const Slam& slam = loop_.slam();
    const std::string& map = options_.scenario.map;
    if (end == LoopEnd::kPlaceUnknown)
      return fmt::format("the car does not know this place in map {}: it searched for {:.1f} s and {:.1f} m", map,
                         slam.search_effort().time_s, slam.search_effort().path_m);
    const bool ended = end == LoopEnd::kTimeUp || end == LoopEnd::kTaskDone;
    if (ended && !options_.manual && slam.search() == Slam::Search::kSearching)
      return fmt::format("the run ended before the car found its place in map {}", map);
    return "";
  }

  // The result, except for the verdict.
  RunResult Judged() {
    RunResult result{.scenario = options_.name, .seed = options_.scenario.seed, .versions = Versions()};
    for (auto& version : plug_.versions()) result.versions.push_back(std::move(version));
    std::optional<GroundTruth> truth;
    StackOutcome outcome;
    faults_.Try([&] { truth = plug_.Truth(); });
    faults_.Try([&] { outcome = OutcomeOf(loop_.slam(), options_.scenario.slam.map_points_min, loop_.stack_ms()); });
    const GroundTruth* const known = truth ? &*truth : nullptr;
    const Measured measured = Measure(outcome, known, faults_);
    const std::string title = options_.name + ", seed " + std::to_string(options_.scenario.seed);
    const Hashes written = WriteRun(title, outcome, known, measured, folder_, faults_);
    if (plug_.traits().repeats) {
      result.hashes = written;
      if (truth) result.hashes.state = truth->state_hash;
      result.hashes.depth = frames_.depth.Hex();
      if (robot_.color != nullptr) result.hashes.color = frames_.color.Hex();
    }
    result.metrics = WithOwnFigures(measured.metrics);
    result.checks = Evaluate(options_.scenario.checks, result.metrics, plug_.traits().knows_truth, options_.name);
    return result;
  }

  // Metrics of devices, time and memory.
  Metrics WithOwnFigures(Metrics metrics) {
    metrics.wall_time_s = figures_.wall_time_s;
    metrics.setup_s = figures_.setup_s;
    metrics.sim_time_s = figures_.sim_time_s;
    metrics.real_time_factor = figures_.real_time_factor;
    metrics.depth_frames = frames_.depth_frames;
    metrics.color_frames = frames_.color_frames;
    faults_.Try([&] {
      metrics.frames_dropped =
          static_cast<std::int64_t>(robot_.depth->Status().missed + (robot_.color ? robot_.color->Status().missed : 0));
    });
    metrics.peak_rss_mb = PeakRss_mb();
    if (!plug_.traits().knows_truth) metrics.stack_rss_mb = metrics.peak_rss_mb;  // no simulation in this process
    return metrics;
  }

  // Sets the verdict from what has failed so far.
  void Conclude(const Ending& ending, RunReport& report) {
    RunResult& result = report.result;
    if (faults_.get()) report.error = Blamed(faults_.get(), plug_.traits());
    result.fault = report.error ? What(report.error) : ending.reason;
    result.verdict = report.error                          ? Verdict::kFail
                     : ending.end == LoopEnd::kInterrupted ? Verdict::kInterrupted
                     : !result.fault.empty()               ? Verdict::kFail
                                                           : Judge(result.checks);
  }

  const RunOptions& options_;
  Plug& plug_;
  Robot robot_;
  const std::atomic<bool>& stop_;
  OutputFolder folder_;
  DriveLoop loop_;
  FrameHashes frames_;
  Metrics figures_;
  FirstFault faults_;
};

// The map to start in; nothing where the scenario names none. Throws InputError.
std::optional<SavedMap> FormerMap(const RunOptions& options) {
  const std::filesystem::path file = options.scenario.map;
  if (file.empty()) return std::nullopt;
  std::error_code ignored;
  if (std::filesystem::equivalent(file.parent_path().empty() ? "." : file.parent_path(), options.out, ignored))
    throw InputError("map", file.string() + " is in the folder that this run is to replace",
                     "another folder for --out");
  return ReadSavedMap(file);
}

}  // namespace

RunReport RunScenario(const RunOptions& asked, const PlugMaker& make_plug, const std::atomic<bool>& stop) {
  const WallClock::time_point begin = WallClock::now();
  if (IsOnTurntable(asked.scenario.task) && asked.manual)
    throw InputError("task.behavior", asked.scenario.task.behavior + ": the car cannot be driven on the turntable",
                     "merlin run");
  RunOptions options = asked;
  std::vector<std::string> warnings;
  const CarDescription car = BelievedCar(options.scenario.car);
  LeaveOutWhatTheCarLacks(car, options.scenario.sensors, warnings);
  std::optional<SavedMap> former = FormerMap(options);
  const std::unique_ptr<Plug> plug = make_plug(options);
  RunReport report = Session(options, *plug, car, std::move(former), SecondsSince(begin), stop).Run();
  warnings.insert(warnings.begin(), car.warnings.begin(), car.warnings.end());
  warnings.insert(warnings.begin(), options.scenario.warnings.begin(), options.scenario.warnings.end());
  for (const std::string& warning : warnings) report.note += (report.note.empty() ? "" : "; ") + warning;
  return report;
}

}  // namespace merlin
