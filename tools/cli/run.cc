// `merlin run`: drives a scenario, judges it and reports the result.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "scenarios/config/scenario.h"
#include "scenarios/judge/output_folder.h"
#include "tools/cli/commands.h"
#include "tools/cli/robots.h"
#include "tools/cli/terminal.h"

namespace merlin::cli {
namespace {

struct RunArguments {
  std::string scenario, out, robot = "twin", pace = "fast", gl = "auto";
  std::string seed, duration_s;  // checked when the scenario is read
  int threads = 0;
  std::vector<std::string> sets;
  bool json = false;
};

double PaceOf(const std::string& text) {
  if (text == "fast") return 0.0;
  if (text == "real") return 1.0;
  std::size_t used = 0;
  double pace = 0.0;
  try {
    pace = std::stod(text, &used);
  } catch (const std::exception&) {
  }
  if (used != text.size() || !(pace > 0.0) || !(pace < 1e6))
    throw InputError("--pace", "unknown pace", "fast, real or a number > 0", "'" + text + "'");
  return pace;
}

// Shows progress: a few times a second on a terminal, elsewhere every ten seconds of simulated time.
class Progress {
 public:
  explicit Progress(double duration_s) : duration_s_(duration_s) {}
  void Show(const LoopState& state) {
    const double now_s = Seconds(state.now - state.began);
    if (!line_.on_terminal() && now_s < next_s_) return;
    next_s_ = now_s + 10.0;
    line_.Show(fmt::format("{:6.1f} s of {:.0f} s, {:6.2f} m: {}", now_s, duration_s_, state.path_m, Doing(state)));
  }

 private:
  double duration_s_, next_s_ = 0.0;
  ProgressLine line_;
};

std::string Number(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "unknown";
}
std::string Number(const std::optional<std::int64_t>& count) { return count ? std::to_string(*count) : "unknown"; }

void PrintSummary(const RunReport& report, const std::filesystem::path& out) {
  const RunResult& result = report.result;
  const Metrics& m = result.metrics;
  fmt::print("{} seed {}: {}\n", result.scenario, result.seed, Name(result.verdict));
  for (const Check& check : result.checks) {
    if (!check.judged)
      fmt::print("  not judged: {} (limit {:g}), which this run cannot know\n", check.name, check.limit);
    else
      fmt::print("  {} {:<32} {} (limit {:g})\n", check.pass ? "pass" : "FAIL", check.name, Number(check.value, 3),
                 check.limit);
  }
  if (result.checks.empty()) fmt::print("  nothing was judged: the scenario has no checks\n");
  if (!result.fault.empty()) fmt::print("  stopped: {}\n", result.fault);
  if (!report.note.empty()) fmt::print("  note: {}\n", report.note);
  fmt::print("  drove {} m in {} s, laps: {}, collisions: {}\n", Number(m.distance_m, 2), Number(m.sim_time_s, 1),
             Number(m.laps), Number(m.collisions));
  if (m.place_found_s)
    fmt::print("  found its place in the map after {} s and {} m\n", Number(m.place_found_s, 1),
               Number(m.place_found_m, 2));
  if (m.map_size_m[0] && m.map_size_m[1])
    fmt::print("  map {} x {} m, off the plan by {} and {} %\n", Number(m.map_size_m[0], 2), Number(m.map_size_m[1], 2),
               Number(m.map_size_error_percent[0], 2), Number(m.map_size_error_percent[1], 2));
  std::string before;
  if (const std::int64_t loops = m.loops_closed.value_or(0); loops > 0)
    before = fmt::format(" ({} m as driven, before {} closed)", Number(m.ate_online_rmse_m, 3),
                         loops == 1 ? "the loop was" : fmt::format("{} loops were", loops));
  fmt::print("  path error (ATE) {} m{}, walls within {} m of the true ones (95 %)\n", Number(m.ate_rmse_m, 3), before,
             Number(m.map_to_plan_p95_m, 3));
  fmt::print("  {} times real time, {} ms a frame in the stack (p50), colour: {}\n", Number(m.real_time_factor, 2),
             Number(m.stack_ms.p50, 1), report.gl_name.empty() ? "none" : report.gl_name);
  const auto print_hash = [](const char* name, const std::optional<std::string>& hash) {
    fmt::print("  {:<10} {}\n", name, hash.value_or("none"));
  };
  print_hash("state", result.hashes.state);
  print_hash("depth", result.hashes.depth);
  print_hash("color", result.hashes.color);
  print_hash("trajectory", result.hashes.trajectory);
  print_hash("map", result.hashes.map);
  fmt::print("files: {} (look at map.png)\n", out.string());
}

int Run(const RunArguments& arguments) {
  RunOptions options;
  options.name = std::filesystem::path(arguments.scenario).stem().string();
  std::vector<std::string> sets = arguments.sets;
  if (!arguments.seed.empty()) sets.push_back("seed=" + arguments.seed);
  if (!arguments.duration_s.empty()) sets.push_back("duration_s=" + arguments.duration_s);
  options.scenario = ReadScenario(arguments.scenario, sets);
  const PlugMaker make_plug = PlugOf(arguments.robot, options);
  options.out = arguments.out.empty()
                    ? std::filesystem::path("runs") / fmt::format("{}-{}", options.name, options.scenario.seed)
                    : std::filesystem::path(arguments.out);
  options.gl = GlOf(arguments.gl);
  options.threads = arguments.threads;
  options.pace = PaceOf(arguments.pace);
  OutputFolder::Check(options.out);
  RunReport report;
  {
    Progress progress(options.scenario.duration_s);
    if (!arguments.json) options.progress = [&progress](const LoopState& state) { progress.Show(state); };
    report = RunScenario(options, make_plug, interrupted);
  }
  if (arguments.json) {
    if (!report.note.empty()) fmt::print(stderr, "merlin: {}\n", report.note);
    fmt::print("{}", ToJson(report.result));
  } else {
    PrintSummary(report, options.out);
  }
  std::fflush(stdout);  // print what was reported so far before the error
  if (report.error) std::rethrow_exception(report.error);
  return ExitCodeOf(report.result.verdict);
}

}  // namespace

void AddRun(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* run = app.add_subcommand("run", "runs a scenario and judges it");
  run->add_option("scenario", arguments->scenario, "a name in scenarios/, or a path")->required();
  run->add_option("--seed", arguments->seed, "of all randomness; default the scenario's")->check(WholeNumber);
  run->add_option("--out", arguments->out, "folder for the results; default runs/<scenario>-<seed>")->check(NotEmpty);
  run->add_option("--robot", arguments->robot,
                  "twin (default); emulated: the twin behind the real drivers and protocols, in real time; or "
                  "hardware:FILE, which names the car's devices");
  run->add_option("--pace", arguments->pace, "fast (default), real, or a factor of real time");
  run->add_option("--gl", arguments->gl, "how colour is drawn; off: depth only")
      ->check(CLI::IsMember({"auto", "egl", "osmesa", "off"}));
  run->add_option("--threads", arguments->threads,
                  "same bits for any number; default: one for the loop, and one for each camera")
      ->check(CLI::Range(1, 256));
  run->add_option("--set", arguments->sets, "a.b=c, over the scenario's file; may be repeated")
      ->allow_extra_args(false);
  run->add_option("--duration", arguments->duration_s, "seconds, instead of the scenario's")->check(NotEmpty);
  run->add_flag("--json", arguments->json, "print result.json instead of the summary");
  run->callback([arguments, &exit_code] { exit_code = Run(*arguments); });
}

}  // namespace merlin::cli
