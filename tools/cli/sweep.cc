// `merlin sweep`: runs a scenario with many settings and seeds, and tests whether the results keep their limits.
#include <memory>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "tools/cli/commands.h"
#include "tools/sweep/sweep_file.h"
#if MERLIN_TWIN
#include <fmt/format.h>

#include <filesystem>

#include "tools/cli/terminal.h"
#include "tools/sweep/sweep.h"
#endif

namespace merlin::cli {
namespace {

struct SweepArguments {
  std::string file, out;
  int jobs = 0;
  SweepChoice choice;
};

#if MERLIN_TWIN
int RunSweepOf(const SweepArguments& arguments) {
  const Sweep sweep = ReadSweep(arguments.file, arguments.choice);
  SweepOptions options{
      .name = std::filesystem::path(arguments.file).stem().string(), .out = arguments.out, .jobs = arguments.jobs};
  if (arguments.out.empty()) options.out = std::filesystem::path("runs") / options.name;
  SweepReport report;
  {
    ProgressLine line;
    line.Show(fmt::format("{} runs", sweep.runs.size()));
    report = RunSweep(sweep, options, interrupted, [&line](const SweepProgress& now) {
      line.Show(fmt::format("{} of {} runs, {} did not pass; {}", now.done, now.of, now.failed, now.last));
    });
  }
  if (report.interrupted) {
    fmt::print(stderr, "merlin: interrupted; the same command goes on from here\n");
    return kInterrupted;
  }
  fmt::print("{}\n", ToMarkdown(report.table));
  fmt::print("{} of {} runs were taken over from before\nfiles: {} (look at table.png)\n", report.taken_over,
             sweep.runs.size(), options.out.string());
  if (report.worst_exit != 0) return report.worst_exit;
  return report.table.MissesALimit() ? kFail : kPass;
}
#else
int RunSweepOf(const SweepArguments&) { throw InputError("merlin sweep: this program was built without the twin"); }
#endif

}  // namespace

void AddSweep(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* sweep =
      app.add_subcommand("sweep", "runs a scenario in many settings and on many seeds, and judges them together");
  sweep->add_option("file", arguments->file, "a name in scenarios/sweeps/, or a path")->required();
  sweep
      ->add_option("--out", arguments->out,
                   "folder for the table and the runs; default runs/<name>. Runs that are there already are taken over "
                   "where program, scenario and seed are the same")
      ->check(NotEmpty);
  sweep->add_option("--jobs", arguments->jobs, "runs at a time; default the number of cores")
      ->check(CLI::Range(1, 1024));
  sweep->add_option("--seeds", arguments->choice.seeds, "such as 1-5 or 1,4,7-9, instead of the file's")
      ->check(NotEmpty);
  sweep->add_option("--row", arguments->choice.rows, "only the row of this name; may be repeated")
      ->allow_extra_args(false);
  sweep->footer(
      "Exit 1: a limit of the file is missed. The format of the file is told in scenarios/sweeps/envelope.yaml.");
  sweep->callback([arguments, &exit_code] { exit_code = RunSweepOf(*arguments); });
}

}  // namespace merlin::cli
