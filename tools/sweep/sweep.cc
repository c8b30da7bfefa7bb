#include "tools/sweep/sweep.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>

#include "robot/base/error.h"
#include "robot/base/files.h"
#include "robot/base/sha256.h"
#include "scenarios/config/names.h"
#include "scenarios/judge/output_path.h"
#include "tools/sweep/process_pool.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

constexpr char kMarker[] = ".merlin-sweep";
constexpr char kKey[] = "sweep_key.txt";  // in a run's folder: identifies program, models, scenario and seed

// The folder of a sweep, locked against other sweeps.
class SweepFolder {
 public:
  explicit SweepFolder(const fs::path& path) {
    std::error_code error;
    const fs::path marker = path / kMarker;
    if (fs::exists(path, error) && !fs::is_directory(path, error))
      RefuseOutput(path, "a folder", "something that is not one");
    if (fs::is_directory(path, error) && !fs::is_empty(path, error) && !fs::exists(marker, error))
      RefuseOutput(path, "an empty folder, a new one, or one that a sweep left", "a folder with other files in it");
    fs::create_directories(path, error);
    if (error) RefuseOutput(path, "cannot be made", error.value());
    marker_ = ::open(marker.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (marker_ < 0) RefuseOutput(path, "cannot be written", errno);
    if (::flock(marker_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(marker_);
    RefuseOutput(path, "an empty folder, a new one, or one that a sweep left",
                 "a folder in which another sweep is at work");
  }
  ~SweepFolder() { ::close(marker_); }
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

 private:
  int marker_ = -1;
};

// The part of the key that all runs share: the program and the models.
std::string HashOfProgram() {
  Sha256 hash;
  hash.Add(ReadFile("/proc/self/exe", "this program"));
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(Home() / "models"))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    hash.Add(fs::relative(file, Home()).string());
    hash.Add(ReadFile(file, "a model"));
  }
  return hash.Hex();
}

// Runs with the same key give the same result, bit by bit. Files that the scenario names by path enter by their
// content.
std::string KeyOf(const SweepRun& run, const std::string& program) {
  const Scenario& scenario = run.scenario;
  Sha256 hash;
  hash.Add(program);
  hash.Add(ToYaml(scenario));
  for (const fs::path& file :
       {RoomFile(scenario.room), CarFile(scenario.car.model), DepthCameraFile(scenario.sensors.depth.camera)})
    hash.Add(ReadFile(file, "a model"));
  if (!scenario.car.calibration.empty()) hash.Add(ReadFile(scenario.car.calibration, "a calibration"));
  return hash.Hex() + "\n";
}

std::string Contents(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) ? ReadFile(file, "a key") : "";
}

class Session {
 public:
  Session(const Sweep& sweep, const SweepOptions& options, const std::function<void(const SweepProgress&)>& progress)
      : sweep_(sweep), options_(options), progress_(progress), folder_(options.out), outcomes_(sweep.runs.size()) {
    now_.of = sweep.runs.size();
    const std::string program = HashOfProgram();
    for (std::size_t i = 0; i < sweep.runs.size(); ++i) {
      keys_.push_back(KeyOf(sweep.runs[i], program));
      const auto outcome = ReadOutcome(FolderOf(i), sweep.runs[i].scenario);
      if (outcome && Contents(FolderOf(i) / kKey) == keys_[i])
        Note(i, *outcome), ++now_.taken_over;
      else
        to_run_.push_back(i);
    }
  }

  SweepReport Run(const std::atomic<bool>& stop) {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const int runs = static_cast<int>(to_run_.size());
    const int jobs = std::clamp(options_.jobs > 0 ? options_.jobs : cores, 1, std::max(1, runs));
    std::vector<Command> commands;
    for (const std::size_t i : to_run_) commands.push_back(CommandOf(i, std::max(1, cores / jobs)));
    RunCommands(commands, jobs, stop, [&](std::size_t command, int code) {
      if (!stop.load()) End(to_run_[command], code);
    });
    SweepReport report{
        .table = {}, .taken_over = now_.taken_over, .interrupted = stop.load(), .worst_exit = worst_exit_};
    if (report.interrupted) return report;
    report.table = MakeTable(options_.name, sweep_, outcomes_);
    WriteFile(options_.out / "table.md", ToMarkdown(report.table));
    WriteFile(options_.out / "table.csv", ToCsv(report.table));
    WriteFile(options_.out / "runs.csv", RunsToCsv(sweep_, outcomes_));
    WriteFile(options_.out / "table.png", ToPng(report.table));
    return report;
  }

 private:
  std::string NameOf(std::size_t i) const {
    return fmt::format("{}-{}", sweep_.rows[sweep_.runs[i].row].name, sweep_.runs[i].seed);
  }
  fs::path FolderOf(std::size_t i) const { return options_.out / NameOf(i); }
  fs::path LogOf(std::size_t i) const { return options_.out / (NameOf(i) + ".log"); }

  Command CommandOf(std::size_t i, int threads) const {
    const SweepRun& run = sweep_.runs[i];
    Command command{{"run", sweep_.rows[run.row].scenario, "--seed", std::to_string(run.seed), "--out",
                     FolderOf(i).string(), "--threads", std::to_string(threads)},
                    LogOf(i)};
    for (const std::string& set : run.sets) command.arguments.insert(command.arguments.end(), {"--set", set});
    return command;
  }

  // Handles a run that has ended. Its exit code says whether there is a result.
  void End(std::size_t i, int code) {
    std::optional<SweepOutcome> outcome;
    if (code == 0 || code == 1) outcome = ReadOutcome(FolderOf(i), sweep_.runs[i].scenario);
    if (outcome) {
      WriteFile(FolderOf(i) / kKey, keys_[i]);
    } else {
      worst_exit_ = std::max(worst_exit_, code == 2 || code == 3 ? code : 4);
      outcome = SweepOutcome{.why = fmt::format("no result (exit {}): {}", code, LastLine(LogOf(i)))};
    }
    Note(i, *outcome);
    progress_(now_);
  }

  void Note(std::size_t i, const SweepOutcome& outcome) {
    outcomes_[i] = outcome;
    ++now_.done;
    if (!outcome.passed) ++now_.failed;
    const std::string ate = outcome.ate_rmse_m ? fmt::format(", ATE {:.3f} m", *outcome.ate_rmse_m) : "";
    now_.last = fmt::format("{} seed {}: {}{}", sweep_.rows[sweep_.runs[i].row].name, sweep_.runs[i].seed,
                            outcome.passed ? "pass" : "FAIL", ate) +
                (outcome.passed ? "" : ": " + outcome.why);
  }

  const Sweep& sweep_;
  const SweepOptions& options_;
  const std::function<void(const SweepProgress&)>& progress_;
  SweepFolder folder_;
  std::vector<SweepOutcome> outcomes_;  // of all runs of the sweep
  std::vector<std::string> keys_;
  std::vector<std::size_t> to_run_;
  SweepProgress now_;
  int worst_exit_ = 0;
};

}  // namespace

SweepReport RunSweep(const Sweep& sweep, const SweepOptions& options, const std::atomic<bool>& stop,
                     const std::function<void(const SweepProgress&)>& progress) {
  return Session(sweep, options, progress).Run(stop);
}

}  // namespace merlin
