// `merlin emulate`: serves a simulated car's devices to another program.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "tools/cli/commands.h"
#if MERLIN_TWIN
#include "scenarios/judge/alignment.h"
#include "scenarios/judge/output_path.h"
#include "scenarios/judge/writers.h"
#include "scenarios/run/emulate.h"
#include "tools/cli/robots.h"
#endif

namespace merlin::cli {
namespace {

struct EmulateArguments {
  std::string scenario, hardware_file, out, gl = "auto", seed;
  int threads = 0;
  std::vector<std::string> sets;
};

#if MERLIN_TWIN

int ServeCar(const EmulateArguments& arguments) {
  std::vector<std::string> sets = arguments.sets;
  if (!arguments.seed.empty()) sets.push_back("seed=" + arguments.seed);
  if (!arguments.out.empty()) CheckOutputFile(arguments.out);
  EmulateOptions options;
  options.run.scenario = ReadScenario(arguments.scenario, sets);
  options.hardware_file = arguments.hardware_file;
  options.say = [](const std::string& sentence) {
    fmt::print("{}\n", sentence);
    std::fflush(stdout);
  };
  options.run.gl = GlOf(arguments.gl);
  options.run.threads = arguments.threads;
  const EmulateReport report = Emulate(options, interrupted);
  if (!arguments.out.empty()) WriteFile(arguments.out, ToTum(report.truth));
  fmt::print("the car drove {:.2f} m, {} collisions{}\n", PathLength_m(report.truth), report.collisions,
             arguments.out.empty() ? "" : "; its true path: " + arguments.out);
  if (report.car_lost.empty()) return kInterrupted;
  fmt::print("stopped: {}\n", report.car_lost);
  return kFail;
}

#else

int ServeCar(const EmulateArguments&) { throw MachineError("this build has no twin (MERLIN_TWIN=OFF)"); }

#endif

}  // namespace

void AddEmulate(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<EmulateArguments>();
  CLI::App* emulate =
      app.add_subcommand("emulate", "serves the simulated car's devices to another program, until Ctrl-C");
  emulate->add_option("scenario", arguments->scenario, "a name in scenarios/, or a path")->required();
  emulate
      ->add_option(
          "--hardware-file", arguments->hardware_file,
          "is written once every device answers, and removed at the end: run --robot hardware:FILE drives them")
      ->required()
      ->check(NotEmpty);
  emulate->add_option("--out", arguments->out, "file for the car's true path (TUM), written at the end")
      ->check(NotEmpty);
  emulate->add_option("--seed", arguments->seed, "of all randomness; default the scenario's")->check(WholeNumber);
  emulate->add_option("--gl", arguments->gl, "how colour is drawn; off: no colour camera")
      ->check(CLI::IsMember({"auto", "egl", "osmesa", "off"}));
  emulate->add_option("--threads", arguments->threads, "default: one for the world, and one for each camera")
      ->check(CLI::Range(1, 256));
  emulate->add_option("--set", arguments->sets, "a.b=c, over the scenario's file; may be repeated")
      ->allow_extra_args(false);
  emulate->callback([arguments, &exit_code] { exit_code = ServeCar(*arguments); });
}

}  // namespace merlin::cli
